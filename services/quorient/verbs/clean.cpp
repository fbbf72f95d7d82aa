#include "quorient/bus/roudi.hpp"
#include "quorient/runtime/heartbeat.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace quorient::cli {

namespace {

namespace fs = std::filesystem;

/// Paths that some process has open or mapped, with the process's name. Without root's rights: of this user's processes.
class LiveFiles {
public:
    LiveFiles()
    {
        std::error_code gone;  // processes end while they are looked at
        for (fs::directory_iterator process{"/proc", gone}, end; !gone && process != end; process.increment(gone)) {
            const auto id = process->path().filename().string();
            if (id.find_first_not_of("0123456789") == std::string::npos && id != std::to_string(::getpid())) look(process->path());
        }
    }

    /// @returns "name (id)" of a process that uses the file; empty where none does.
    std::string owner(const fs::path& file) const
    {
        // A socket has no path among the open files; its lock beside it has. Fast DDS opens a port's semaphore for moments, the port for
        // good.
        for (const auto& path : {file.string(), file.string() + ".lock", guarded_by(file)}) {
            if (const auto found = owners_.find(path); found != owners_.end()) return found->second;
        }
        return {};
    }

private:
    /// "/dev/shm/sem.fastrtps_port7410_mutex" guards "/dev/shm/fastrtps_port7410"; in Fast DDS 3 the names begin with "fastdds".
    static std::string guarded_by(const fs::path& semaphore)
    {
        constexpr std::string_view prefix = "sem.", suffix = "_mutex";
        const auto name = semaphore.filename().string();
        if (!name.starts_with(prefix) || !name.ends_with(suffix)) return semaphore.string();
        return semaphore.parent_path() / name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
    }

    void look(const fs::path& process)
    {
        std::string name;
        std::ifstream comm{process / "comm"};
        std::getline(comm, name);
        const auto owner = fmt::format("{} ({})", name, process.filename().string());
        std::error_code gone;
        for (fs::directory_iterator entry{process / "fd", gone}, end; !gone && entry != end; entry.increment(gone)) {
            std::error_code closed;
            owners_.try_emplace(fs::read_symlink(entry->path(), closed).string(), owner);
        }
        std::ifstream maps{process / "maps"};
        for (std::string line; std::getline(maps, line);) {
            if (const auto path = line.find('/'); path != std::string::npos) owners_.try_emplace(line.substr(path), owner);
        }
    }

    std::map<std::string, std::string> owners_;
};

/// After which RouDi names its segment.
std::string group_name()
{
    const auto* group = ::getgrgid(::getegid());
    return group ? group->gr_name : "";
}

bool starts_with_any(const std::string& name, std::initializer_list<const char*> prefixes)
{
    for (const char* prefix : prefixes) {
        if (name.starts_with(prefix)) return true;
    }
    return false;
}

bool is_mine(const fs::path& file)
{
    struct stat status {};
    return ::lstat(file.c_str(), &status) == 0 && status.st_uid == ::geteuid();
}

template <class Predicate>
void collect(const fs::path& folder, Predicate chosen, std::set<fs::path>& found)
{
    std::error_code unreadable;
    for (fs::directory_iterator entry{folder, unreadable}, end; !unreadable && entry != end; entry.increment(unreadable)) {
        if (chosen(entry->path().filename().string()) && is_mine(entry->path())) found.insert(entry->path());
    }
}

/// What Fast DDS, iceoryx and our processes leave when they are killed.
std::set<fs::path> leftovers()
{
    std::set<fs::path> found;
    collect(
        "/dev/shm",
        [](const std::string& name) {
            return starts_with_any(name, {"fastrtps_", "fastdds_", "fast_datasharing_", "sem.fastrtps_", "sem.fastdds_"});
        },
        found);
    collect(
        runtime::run_directory(), [](const std::string& name) { return name.ends_with(".heartbeat"); }, found);
    if (bus::roudi_answers()) return found;  // its files and its clients' are in use
    collect(
        runtime::run_directory(), [](const std::string& name) { return name == "roudi.toml"; }, found);
    collect(
        "/dev/shm", [](const std::string& name) { return name == "iceoryx_mgmt"; }, found);
    if (found.contains("/dev/shm/iceoryx_mgmt")) {
        const auto group = fs::path{"/dev/shm"} / group_name();
        if (is_mine(group)) found.insert(group);
    }
    collect(
        "/tmp", [](const std::string& name) { return name == "roudi" || name == "roudi.lock" || name.starts_with("iceoryx_rt_"); }, found);
    return found;
}

struct CleanOptions {
    bool dry_run = false;
};

int clean(const CleanOptions& options)
{
    const LiveFiles live;
    int kept = 0;
    for (const auto& file : leftovers()) {
        if (const auto owner = live.owner(file); !owner.empty()) {
            fmt::print(stderr, "kept {}: {} uses it\n", file.string(), owner);
            ++kept;
            continue;
        }
        std::error_code refused;
        if (!options.dry_run) fs::remove(file, refused);
        if (refused) {
            fmt::print(stderr, "kept {}: {}\n", file.string(), refused.message());
            ++kept;
        } else {
            fmt::print("{}\n", file.string());
        }
    }
    return kept == 0 ? ExitCode::done : ExitCode::not_as_asked;
}

}  // namespace

void add_clean(Program& program)
{
    auto verb = program.verb("clean", "Remove what killed processes left: shared memory, sockets, heartbeats");
    auto options = std::make_shared<CleanOptions>();
    verb.flag("--dry-run", options->dry_run, "Only print what would be removed");
    verb.footer(
        "Removes files of this user that no running process uses: Fast DDS's and iceoryx's in /dev/shm, iceoryx's sockets in /tmp, and the "
        "heartbeats in the run directory; logs stay. What is in use is kept and named.\nExample:\n  quorient clean --dry-run");
    verb.not_as_asked_if("something was kept");
    verb.run([options] {
        if (const int exit_code = clean(*options); exit_code != 0) throw Exit{exit_code};
    });
}

}  // namespace quorient::cli
