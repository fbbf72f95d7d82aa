#include "run.hpp"

#include <gtest/gtest.h>
#include <malloc.h>
#include <signal.h>
#include <unistd.h>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>

namespace quorient::fuzz {

namespace {

constexpr unsigned hang_s = 30;

/// Without what the allocator keeps for later: once a history of many megabytes was freed it holds on to such blocks.
std::size_t resident_kb()
{
    ::malloc_trim(0);
    std::ifstream statm{"/proc/self/statm"};
    std::size_t pages = 0, resident = 0;
    statm >> pages >> resident;
    return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) / 1024;
}

std::uint64_t number_from(const char* name)
{
    const char* text = std::getenv(name);
    return text == nullptr ? 0 : std::strtoull(text, nullptr, 10);
}

/// The message for an input that ends the process, formatted in advance: a signal handler may write but not format.
std::array<char, 64> last_words{};

void name_input(std::uint64_t seed)
{
    std::snprintf(last_words.data(), last_words.size(), "fuzz_test: ended by input QUORIENT_FUZZ_SEED=%llu\n",
                  static_cast<unsigned long long>(seed));
    ::alarm(hang_s);
}

/// An abort, a fault or an input that takes longer than hang_s still ends the process, which first prints the seed of the input.
void say_which_input_ends_it()
{
    struct sigaction action {};
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    action.sa_handler = [](int signal) {
        const std::string_view words{last_words.data()};
        [[maybe_unused]] const auto written = ::write(STDERR_FILENO, words.data(), words.size());
        ::raise(signal);
    };
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGALRM}) ::sigaction(signal, &action, nullptr);
}

/// What libFuzzer kept (libfuzzer.py --keep): one input per line, hexadecimal.
std::vector<Input> corpus_of(const std::string& target)
{
    std::ifstream file{std::filesystem::path{QUORIENT_SOURCE_DIR} / "integration_tests/fuzz/corpus" / (target + ".txt")};
    std::vector<Input> inputs;
    for (std::string line; std::getline(file, line);) {
        Input input(line.size() / 2);
        for (std::size_t i = 0; i < input.size(); ++i) input[i] = static_cast<std::uint8_t>(std::stoul(line.substr(2 * i, 2), nullptr, 16));
        inputs.push_back(std::move(input));
    }
    return inputs;
}

/// First the corpus as it stands; then in turn random bytes, and two inputs of the corpus with a few bytes damaged.
void make_input(std::uint64_t seed, const std::vector<Input>& corpus, std::size_t longest, Input& input)
{
    if (seed < corpus.size()) {
        input = corpus[seed];
        return;
    }
    std::mt19937_64 random{seed};
    if (seed % 2 == 0) {
        input.resize(1 + random() % longest);
        for (auto& byte : input) byte = static_cast<std::uint8_t>(random());
        return;
    }
    input = corpus[random() % corpus.size()];
    const Input& more = corpus[random() % corpus.size()];
    input.insert(input.end(), more.begin(), more.end());
    for (auto times = random() % 8; times > 0; --times) input[random() % input.size()] = static_cast<std::uint8_t>(random());
}

}  // namespace

void run(const char* name, void (*target)(const std::uint8_t*, std::size_t), std::uint64_t inputs, std::size_t longest, std::vector<Input> more)
{
    std::vector<Input> corpus = corpus_of(name);
    corpus.insert(corpus.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    ASSERT_FALSE(corpus.empty()) << "no corpus " << name;
    inputs += corpus.size();
    const std::uint64_t warm = inputs / 2;
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const auto end = begin + std::chrono::seconds{number_from("QUORIENT_FUZZ_SECONDS")};
    const std::uint64_t first = number_from("QUORIENT_FUZZ_SEED");
    Input input;
    input.reserve(longest);
    std::uint64_t done = 0;
    std::size_t warm_kb = 0;
    say_which_input_ends_it();
    for (; done < inputs || Clock::now() < end; ++done) {
        const std::uint64_t seed = first + done;
        name_input(seed);
        make_input(seed, corpus, longest, input);
        target(input.data(), input.size());
        if (done == warm) warm_kb = resident_kb();
    }
    ::alarm(0);
    const double took_s = std::chrono::duration<double>(Clock::now() - begin).count();
    const auto last_kb = resident_kb();
    std::printf("%llu executions from input %llu, %.0f/s, %zu KiB at the end, %+lld since input %llu\n",
                static_cast<unsigned long long>(done), static_cast<unsigned long long>(first), static_cast<double>(done) / took_s, last_kb,
                static_cast<long long>(last_kb) - static_cast<long long>(warm_kb), static_cast<unsigned long long>(first + warm));
    EXPECT_LT(last_kb, warm_kb + 4096) << "it grows";
}

}  // namespace quorient::fuzz
