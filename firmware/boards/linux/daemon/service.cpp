// SPDX-License-Identifier: Apache-2.0
#include "daemon/service.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

namespace millforce::host {

namespace {

/// Above the kernel's threaded interrupts (50), so that a flood elsewhere does not delay the tick.
constexpr int real_time_priority = 60;

std::atomic<bool> stop_asked{false};
std::atomic<bool> reopen_asked{false};

void ask_to_stop(int) {
    stop_asked.store(true);
}

void ask_to_reopen(int) {
    reopen_asked.store(true);
}

void handle(int signal, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
}

/// The whole number in a variable of the environment; 0: none.
std::uint64_t number_in(const char* variable) {
    const char* text = std::getenv(variable);
    return text != nullptr ? std::strtoull(text, nullptr, 10) : 0;
}

}  // namespace

std::vector<std::string> become_real_time() {
    std::vector<std::string> notes;
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
        notes.push_back(fmt::format("memory is not locked ({}); allow it with LimitMEMLOCK=infinity or CAP_IPC_LOCK",
                                    std::strerror(errno)));
    }
    sched_param parameters{};
    parameters.sched_priority = real_time_priority;
    if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters); error != 0) {
        notes.push_back(fmt::format("no real-time priority ({}); allow it with LimitRTPRIO={} or CAP_SYS_NICE",
                                    std::strerror(error), real_time_priority));
    }
    return notes;
}

void leave_real_time() {
    const sched_param usual{};
    pthread_setschedparam(pthread_self(), SCHED_OTHER, &usual);
}

const std::atomic<bool>& stop_on_signal() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        handle(signal, ask_to_stop);
    }
    for (const int signal : {SIGPIPE, SIGXFSZ}) {
        handle(signal, SIG_IGN);
    }
    handle(SIGUSR1, ask_to_reopen);
    return stop_asked;
}

bool take_reopen_request() {
    return reopen_asked.exchange(false);
}

ServiceWatchdog::ServiceWatchdog() {
    const std::uint64_t process = number_in("WATCHDOG_PID");
    if (process == 0 || process == static_cast<std::uint64_t>(getpid())) {
        period_us_ = number_in("WATCHDOG_USEC") / 2;
    }
}

void ServiceWatchdog::poll(std::uint64_t now_us) {
    if (period_us_ > 0 && now_us >= next_us_) {
        next_us_ = now_us + period_us_;
        notify_service_manager("WATCHDOG=1");
    }
}

void notify_service_manager(const char* state) {
    const char* name = std::getenv("NOTIFY_SOCKET");
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (name == nullptr || std::strlen(name) < 2 || std::strlen(name) >= sizeof address.sun_path) {
        return;
    }
    std::memcpy(address.sun_path, name, std::strlen(name));
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + std::strlen(name));
    if (name[0] == '@') {  // a name that is in no file system
        address.sun_path[0] = '\0';
    }
    const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (descriptor >= 0) {
        sendto(descriptor, state, std::strlen(state), MSG_NOSIGNAL | MSG_DONTWAIT,
               reinterpret_cast<const sockaddr*>(&address), length);
        close(descriptor);
    }
}

}  // namespace millforce::host
