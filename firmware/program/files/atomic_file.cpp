// SPDX-License-Identifier: Apache-2.0
#include "files/atomic_file.hpp"

#include "files/input_error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>

namespace millforce::host {

namespace {

constexpr std::size_t most_open = 16;

// Names of unfinished files, for a signal handler: it may neither allocate nor lock.
struct Slot {
    std::atomic<bool> taken{false};
    std::atomic<const char*> name{nullptr};
};
std::array<Slot, most_open> unfinished;

std::size_t remember(const char* name, const std::filesystem::path& target) {
    for (std::size_t k = 0; k < most_open; ++k) {
        bool expected = false;
        if (unfinished[k].taken.compare_exchange_strong(expected, true)) {
            unfinished[k].name = name;
            return k;
        }
    }
    throw InputError(fmt::format("{}: more than {} output files are open at once", target.string(), most_open));
}

void forget(std::size_t slot) {
    unfinished[slot].name = nullptr;
    unfinished[slot].taken = false;
}

[[noreturn]] void fail(const std::filesystem::path& target, const char* what, int error) {
    throw InputError(fmt::format("{}: {}: {}", target.string(), what, std::strerror(error)));
}

/// A rename would replace a symbolic link instead of the file that it points to.
std::filesystem::path behind_links(const std::filesystem::path& target) {
    std::error_code error;
    const std::filesystem::path real = std::filesystem::canonical(target, error);
    return error ? target : real;
}

int open_beside(const std::filesystem::path& target, std::string& temporary) {
    std::error_code ignored;
    if (target.filename().empty() || std::filesystem::is_directory(target, ignored)) {
        throw InputError(fmt::format("'{}' is a folder; expected the name of a file to write", target.string()));
    }
    if (std::filesystem::exists(target, ignored) && !std::filesystem::is_regular_file(target, ignored)) {
        throw InputError(
            fmt::format("'{}' is a device or pipe; expected the name of a file to write", target.string()));
    }
    temporary = fmt::format("{}.{}.unfinished-XXXXXX", target.string(), ::getpid());
    const int descriptor = ::mkostemp(temporary.data(), O_CLOEXEC);
    if (descriptor < 0) {
        fail(target, "cannot be written", errno);
    }
    // mkostemp makes a private file; the result should have the permissions of any other output.
    const mode_t mask = ::umask(0);
    ::umask(mask);
    static_cast<void>(::fchmod(descriptor, 0666U & ~mask));
    return descriptor;
}

}  // namespace

AtomicFile::Buffer::Buffer(int descriptor) : descriptor_(descriptor), memory_(std::size_t{1} << 16U) {
    setp(memory_.data(), memory_.data() + memory_.size());
}

bool AtomicFile::Buffer::flush() {
    const char* next = pbase();
    while (next < pptr()) {
        const ssize_t written = ::write(descriptor_, next, static_cast<std::size_t>(pptr() - next));
        if (written < 0 && errno != EINTR) {
            return false;
        }
        next += written > 0 ? written : 0;
    }
    setp(memory_.data(), memory_.data() + memory_.size());
    return true;
}

AtomicFile::Buffer::int_type AtomicFile::Buffer::overflow(int_type letter) {
    if (!flush()) {
        return traits_type::eof();
    }
    if (!traits_type::eq_int_type(letter, traits_type::eof())) {
        *pptr() = traits_type::to_char_type(letter);
        pbump(1);
    }
    return traits_type::not_eof(letter);
}

int AtomicFile::Buffer::sync() {
    return flush() ? 0 : -1;
}

AtomicFile::AtomicFile(const std::filesystem::path& target)
    : target_(behind_links(target)),
      descriptor_(open_beside(target_, temporary_)),
      slot_(most_open),
      buffer_(descriptor_),
      stream_(&buffer_) {
    try {
        slot_ = remember(temporary_.c_str(), target_);
    } catch (...) {
        discard();
        throw;
    }
}

AtomicFile::~AtomicFile() {
    discard();
}

void AtomicFile::discard() {
    if (!open_) {
        return;
    }
    open_ = false;
    ::close(descriptor_);
    ::unlink(temporary_.c_str());
    if (slot_ < most_open) {
        forget(slot_);
    }
}

void AtomicFile::commit() {
    if (!open_) {
        return;
    }
    errno = 0;
    stream_.flush();
    if (!stream_ || ::fsync(descriptor_) != 0 || std::rename(temporary_.c_str(), target_.c_str()) != 0) {
        const int error = errno != 0 ? errno : EIO;
        discard();
        fail(target_, "cannot be written", error);
    }
    open_ = false;
    ::close(descriptor_);
    forget(slot_);
}

void remove_unfinished_files() noexcept {
    for (Slot& slot : unfinished) {
        if (const char* name = slot.name.load(); name != nullptr) {
            ::unlink(name);
        }
    }
}

extern "C" {
static void clean_up_and_end(int signal) {
    remove_unfinished_files();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}
}

void remove_unfinished_files_on_interrupt() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
        std::signal(signal, clean_up_and_end);
    }
}

}  // namespace millforce::host
