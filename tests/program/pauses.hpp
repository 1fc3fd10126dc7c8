// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/wait.h>

#include <csignal>
#include <stdexcept>

/// Ways to stop a process of ours, each until the object ends.

namespace millforce::test {

inline void await_stop(pid_t process) {
    int status = 0;
    if (::waitpid(process, &status, WUNTRACED | __WALL) != process || !WIFSTOPPED(status)) {
        throw std::runtime_error("the process does not stop");
    }
}

/// All of it, by SIGSTOP.
class Stopped {
  public:
    explicit Stopped(pid_t process) : process_(process) {
        ::kill(process_, SIGSTOP);
        await_stop(process_);
    }
    ~Stopped() { ::kill(process_, SIGCONT); }
    Stopped(const Stopped&) = delete;
    Stopped& operator=(const Stopped&) = delete;

  private:
    pid_t process_;
};

/// Its first thread, as by a debugger. The others run on.
class Debugged {
  public:
    explicit Debugged(pid_t thread) : thread_(thread) {
        ::ptrace(PTRACE_SEIZE, thread_, nullptr, nullptr);
        ::ptrace(PTRACE_INTERRUPT, thread_, nullptr, nullptr);
        await_stop(thread_);
    }
    ~Debugged() { ::ptrace(PTRACE_DETACH, thread_, nullptr, nullptr); }
    Debugged(const Debugged&) = delete;
    Debugged& operator=(const Debugged&) = delete;

  private:
    pid_t thread_;
};

}  // namespace millforce::test
