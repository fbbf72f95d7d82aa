#pragma once

#include <sys/types.h>
#include <cstdint>
#include <string>
#include <vector>

namespace quorient::launch {

/// One child and what became of it.
struct Child {
    std::string name;
    std::vector<std::string> members;  ///< the processes of the system file that run in it
    std::vector<std::string> command;
    std::string log_file;
    bool daemon = false;  ///< serves the others: stopped after them, and not started again (what they share is gone with it)
    pid_t process = -1;
    int restarts = 0;
    bool ended = false;  ///< in order (exit 0) or for good (exit 2: a restart cannot help)
    int exit_code = 0;
    std::int64_t restart_at_ns = 0;
};

/// Starts, restarts and stops the processes of a system. Children die with this process, however it ends.
class Processes {
public:
    ~Processes();

    /// Started again whenever it dies, unless it ended in order or with exit code 2.
    void add(std::string name, std::vector<std::string> members, std::vector<std::string> command, std::string log_file);

    /// What serves the others: stopped after them, and not started again.
    void add_daemon(std::string name, std::vector<std::string> command, std::string log_file);

    /// For every later start of those that are no daemons.
    void add_arguments(const std::vector<std::string>& arguments);

    /// Starts those that do not run yet.
    void start();

    /// Reaps the dead and starts again what is due. @returns the names of those that died since the last call.
    std::vector<std::string> look(std::int64_t now_ns);

    /// SIGTERM to all; SIGKILL after 2 s to who is left.
    void stop();

    const Child* find(const std::string& name) const;

    /// The child that a process of the system file runs in.
    const Child* find_member(const std::string& member) const;
    const std::vector<Child>& all() const { return children_; }

private:
    template <class Predicate>
    void stop(Predicate chosen);

    std::vector<Child> children_;
};

}  // namespace quorient::launch
