// Writes the seeds of a log's fuzz target as files, for libFuzzer: fuzz_seeds TARGET FOLDER

#include "log_seeds.hpp"

#include <fmt/format.h>
#include <fstream>

int main(int argc, char** argv)
{
    if (argc != 3) return 2;
    int number = 0;
    for (const auto& seed : quorient::fuzz::log_seeds(argv[1])) {
        std::ofstream file(fmt::format("{}/seed{:03}", argv[2], number++), std::ios::binary);
        file.write(reinterpret_cast<const char*>(seed.data()), static_cast<std::streamsize>(seed.size()));
        if (!file.flush()) return 1;
    }
    return 0;
}
