// SPDX-License-Identifier: Apache-2.0
#include "daemon/log_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "files/input_error.hpp"

namespace millforce::host {

namespace {

bool is_regular(int descriptor) {
    struct stat status {};
    return fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

/// Appends wherever the end is: the file may be emptied by a program that copied it. Two programs in one file would
/// mix their lines. -1: errno says why; EWOULDBLOCK: another program writes it.
int opened(const std::string& name) {
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor >= 0 && is_regular(descriptor) && flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
        const int error = errno;
        ::close(descriptor);
        errno = error;
        return -1;
    }
    return descriptor;
}

}  // namespace

LogFile::LogFile(std::string name, std::string missing)
    : name_(std::move(name)), missing_(std::move(missing)), descriptor_(opened(name_)) {
    if (descriptor_ < 0) {
        throw InputError(errno == EWOULDBLOCK
                             ? fmt::format("{}: is being written by a running program, expected another file", name_)
                             : fmt::format("{}: {}, expected a file that can be written", name_, std::strerror(errno)));
    }
    if (is_regular(descriptor_) && ftruncate(descriptor_, 0) != 0) {
        throw InputError(fmt::format("{}: {}, expected a file that can be emptied", name_, std::strerror(errno)));
    }
}

LogFile::~LogFile() {
    ::close(descriptor_);
}

std::string LogFile::missing_line() const {
    return lost_ == reported_lost_ ? std::string{} : fmt::format(fmt::runtime(missing_), lost_ - reported_lost_);
}

int LogFile::flush() {
    if (lines_.empty()) {
        return 0;
    }
    const std::string missing = missing_line();
    const std::string text = missing + lines_;
    lines_.clear();
    int error = 0;
    const std::size_t written = write(text, error);
    const std::size_t whole = written == 0 ? 0 : text.rfind('\n', written - 1) + 1;
    if (whole > 0) {
        reported_lost_ = lost_;
    }
    if (error != 0) {
        ++failures_;
        cut_off(written - whole);
        const auto first_lost = text.begin() + static_cast<std::ptrdiff_t>(std::max(whole, missing.size()));
        lost_ += static_cast<std::uint64_t>(std::count(first_lost, text.end(), '\n'));
    }
    return error;
}

std::size_t LogFile::write(std::string_view text, int& error) const {
    std::size_t done = 0;
    while (done < text.size()) {
        const ssize_t count = ::write(descriptor_, text.data() + done, text.size() - done);
        if (count < 0 && errno != EINTR) {
            error = errno;
            return done;
        }
        done += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    return done;
}

void LogFile::cut_off(std::size_t bytes) const {
    struct stat status {};
    if (bytes > 0 && fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode)) {
        (void)!ftruncate(descriptor_, std::max<off_t>(status.st_size - static_cast<off_t>(bytes), 0));
    }
}

int LogFile::reopen() {
    struct stat now {};
    struct stat next {};
    const bool is_same = fstat(descriptor_, &now) == 0 && stat(name_.c_str(), &next) == 0 &&
                         now.st_dev == next.st_dev && now.st_ino == next.st_ino;
    if (is_same) {
        return 0;
    }
    const int descriptor = opened(name_);
    if (descriptor < 0) {
        return errno;
    }
    ::close(std::exchange(descriptor_, descriptor));
    return 0;
}

}  // namespace millforce::host
