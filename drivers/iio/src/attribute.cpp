// SPDX-License-Identifier: Apache-2.0
#include "iio/attribute.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>

namespace millforce::iio {

namespace {

constexpr std::string_view white_space = " \t\r\n";

bool is_missing(int number) {
    return number == ENOENT || number == ENOTDIR || number == ENODEV || number == ENXIO;
}

IioError read_error(int number) {
    return is_missing(number) ? IioError::file_missing : IioError::file_unreadable;
}

template <typename Value>
IioError parse_whole(std::string_view text, Value& value) {
    Value read{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
    if (error != std::errc{} || end != text.data() + text.size()) {
        return IioError::not_a_number;
    }
    value = read;
    return IioError::none;
}

std::string_view without_number(std::string_view name) {
    const std::size_t last = name.find_last_not_of("0123456789");
    return last == std::string_view::npos ? std::string_view{} : name.substr(0, last + 1);
}

}  // namespace

std::string_view name_of(IioError error) {
    switch (error) {
        case IioError::none:
            return "none";
        case IioError::path_too_long:
            return "path too long";
        case IioError::file_missing:
            return "file missing";
        case IioError::file_unreadable:
            return "file cannot be read";
        case IioError::file_unwritable:
            return "file cannot be written";
        case IioError::not_a_number:
            return "not a number";
        case IioError::scan_format:
            return "not a scan format";
        case IioError::scan_layout:
            return "scan elements contradict each other";
        case IioError::channel_disabled:
            return "channel disabled";
        case IioError::clock:
            return "unknown clock";
        case IioError::settings:
            return "settings";
    }
    return "unknown";
}

Path& Path::append(std::string_view text) {
    if (is_too_long_ || text.size() >= path_capacity - size_) {
        *this = {};
        is_too_long_ = true;
        return *this;
    }
    std::copy(text.begin(), text.end(), text_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += text.size();
    return *this;
}

Attribute read_attribute(int descriptor) {
    Attribute attribute;
    const ssize_t bytes = pread(descriptor, attribute.text.data(), attribute.text.size(), 0);
    if (bytes < 0) {
        attribute.number = errno;
        attribute.error = read_error(errno);
        return attribute;
    }
    attribute.size = static_cast<std::size_t>(bytes);
    if (attribute.size == attribute.text.size()) {
        attribute.error = IioError::not_a_number;
        attribute.size = 0;
        return attribute;
    }
    const std::size_t last = attribute.view().find_last_not_of(white_space);
    attribute.size = last == std::string_view::npos ? 0 : last + 1;
    return attribute;
}

Attribute read_attribute(const Path& path) {
    Attribute attribute;
    if (path.view().empty()) {
        attribute.error = IioError::path_too_long;
        return attribute;
    }
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) {
        attribute.number = errno;
        attribute.error = read_error(errno);
        return attribute;
    }
    attribute = read_attribute(descriptor);
    ::close(descriptor);
    return attribute;
}

IioError parse(std::string_view text, float& value) {
    float read = 0.0F;
    const IioError error = parse_whole(text, read);
    if (error != IioError::none || !(read - read == 0.0F)) {
        return IioError::not_a_number;
    }
    value = read;
    return IioError::none;
}

IioError parse(std::string_view text, std::int64_t& value) {
    return parse_whole(text, value);
}

IioError write_attribute(const Path& path, std::string_view text, int& number) {
    number = 0;
    if (path.view().empty()) {
        return IioError::path_too_long;
    }
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_TRUNC | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) {
        number = errno;
        return is_missing(number) ? IioError::file_missing : IioError::file_unwritable;
    }
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    number = written < 0 ? errno : 0;
    ::close(descriptor);
    return written == static_cast<ssize_t>(text.size()) ? IioError::none : IioError::file_unwritable;
}

IioError write_attribute(const Path& path, std::int64_t value, int& number) {
    std::array<char, 24> text{};
    const auto [end, error] = std::to_chars(text.begin(), text.end(), value);
    return write_attribute(path, {text.data(), static_cast<std::size_t>(end - text.data())}, number);
}

Fault read_shared(const Path& device, std::string_view prefix, std::string_view name, std::string_view suffix,
                  float& value) {
    Fault fault;
    for (const std::string_view stem : {name, without_number(name)}) {
        fault.file = device.file(prefix).append(stem).append(suffix);
        const Attribute attribute = read_attribute(fault.file);
        fault.number = attribute.number;
        fault.error = attribute.error == IioError::none ? parse(attribute.view(), value) : attribute.error;
        if (fault.error != IioError::file_missing) {
            return fault;
        }
    }
    return fault;
}

}  // namespace millforce::iio
