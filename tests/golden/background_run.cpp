#include "tests/golden/background_run.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

namespace graftal {

BackgroundRun::BackgroundRun(const std::string& folder, const std::vector<std::string>& arguments)
    : messages_(folder + "/../messages") {
    id_ = ::fork();
    if (id_ == 0) start(folder, arguments);
}

BackgroundRun::~BackgroundRun() {
    if (id_ <= 0 || ended_) return;
    ::kill(id_, SIGKILL);
    wait();
}

bool BackgroundRun::running() {
    if (!ended_) note(::waitpid(id_, &wait_status_, WNOHANG));
    return !ended_;
}

void BackgroundRun::send(int signal) const {
    ::kill(id_, signal);
}

int BackgroundRun::wait() {
    if (!ended_) note(::waitpid(id_, &wait_status_, 0));
    return WIFEXITED(wait_status_) ? WEXITSTATUS(wait_status_) : -WTERMSIG(wait_status_);
}

std::string BackgroundRun::messages() const {
    std::ifstream file(messages_);
    return {std::istreambuf_iterator<char>(file), {}};
}

bool BackgroundRun::catches(int signal) const {
    std::ifstream status(fmt::format("/proc/{}/status", id_));
    for (std::string word; status >> word;)
        if (word == "SigCgt:" && status >> word)
            return (std::stoull(word, nullptr, 16) >> (signal - 1) & 1) != 0;
    return false;
}

bool BackgroundRun::wait_until(const std::function<bool()>& so) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!so()) {
        if (!running() || std::chrono::steady_clock::now() > end) return so();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

void BackgroundRun::start(const std::string& folder, const std::vector<std::string>& arguments) const {
    ::dup2(::open(messages_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    ::signal(SIGINT, SIG_DFL);
    if (::chdir(folder.c_str()) != 0) ::_exit(125);
    std::vector<char*> words = {const_cast<char*>("graftal")};
    for (const std::string& argument : arguments)
        words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    ::execv(GRAFTAL_PROGRAM, words.data());
    ::_exit(126);
}

} // namespace graftal
