#include "processes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

namespace quorient::launch {

namespace {

constexpr std::int64_t restart_delay_ns = 200'000'000;
constexpr auto stop_patience = std::chrono::seconds{2};

[[noreturn]] void become(const Child& child)
{
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int log = ::open(child.log_file.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
    if (log >= 0) {
        ::dup2(log, STDOUT_FILENO);
        ::dup2(log, STDERR_FILENO);
    }
    std::vector<char*> arguments;
    for (const auto& word : child.command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
}

void spawn(Child& child)
{
    child.process = ::fork();
    if (child.process < 0) throw std::runtime_error(fmt::format("cannot start {}", child.name));
    if (child.process == 0) become(child);
}

}  // namespace

Processes::~Processes()
{
    stop();
}

void Processes::add(std::string name, std::vector<std::string> members, std::vector<std::string> command, std::string log_file)
{
    children_.push_back(
        {.name = std::move(name), .members = std::move(members), .command = std::move(command), .log_file = std::move(log_file)});
}

void Processes::add_daemon(std::string name, std::vector<std::string> command, std::string log_file)
{
    children_.push_back(
        {.name = std::move(name), .members = {}, .command = std::move(command), .log_file = std::move(log_file), .daemon = true});
}

void Processes::add_arguments(const std::vector<std::string>& arguments)
{
    for (auto& child : children_) {
        if (!child.daemon) child.command.insert(child.command.end(), arguments.begin(), arguments.end());
    }
}

void Processes::start()
{
    for (auto& child : children_) {
        if (child.process < 0 && !child.ended) spawn(child);
    }
}

std::vector<std::string> Processes::look(std::int64_t now_ns)
{
    std::vector<std::string> died;
    for (auto& child : children_) {
        int status = 0;
        if (child.process > 0 && ::waitpid(child.process, &status, WNOHANG) == child.process) {
            child.process = -1;
            child.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
            child.ended = child.daemon || child.exit_code == 0 || child.exit_code == 2 || child.exit_code == 127;
            child.restart_at_ns = now_ns + restart_delay_ns;
            died.push_back(child.name);
        }
        if (child.process < 0 && !child.ended && now_ns >= child.restart_at_ns) {
            ++child.restarts;
            spawn(child);
        }
    }
    return died;
}

void Processes::stop()
{
    stop([](const Child& child) { return !child.daemon; });
    stop([](const Child&) { return true; });
}

template <class Predicate>
void Processes::stop(Predicate chosen)
{
    for (const auto& child : children_) {
        if (child.process <= 0 || !chosen(child)) continue;
        ::kill(child.process, SIGTERM);
        ::kill(child.process, SIGCONT);
    }
    const auto deadline = std::chrono::steady_clock::now() + stop_patience;
    for (auto& child : children_) {
        while (child.process > 0 && chosen(child)) {
            if (::waitpid(child.process, nullptr, WNOHANG) == child.process) child.process = -1;
            else if (std::chrono::steady_clock::now() > deadline) ::kill(child.process, SIGKILL);
            if (child.process > 0) std::this_thread::sleep_for(std::chrono::milliseconds{5});
        }
    }
}

const Child* Processes::find(const std::string& name) const
{
    const auto found = std::find_if(children_.begin(), children_.end(), [&](const Child& child) { return child.name == name; });
    return found == children_.end() ? nullptr : &*found;
}

const Child* Processes::find_member(const std::string& member) const
{
    const auto found = std::find_if(children_.begin(), children_.end(), [&](const Child& child) {
        return std::find(child.members.begin(), child.members.end(), member) != child.members.end();
    });
    return found == children_.end() ? nullptr : &*found;
}

}  // namespace quorient::launch
