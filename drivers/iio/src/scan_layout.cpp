// SPDX-License-Identifier: Apache-2.0
#include "iio/scan_layout.hpp"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace millforce::iio {

namespace {

constexpr std::string_view enable_suffix = "_en";
constexpr std::string_view element_prefix = "in_";
constexpr std::size_t channel_capacity = 64;  // of a device, enabled or not

/// Names of the channels that have a scan element, by the system call itself: opendir() uses the heap.
struct ChannelNames {
    std::array<ChannelName, channel_capacity> names{};
    std::size_t count = 0;
    Fault fault{};

    void take(std::string_view file) {
        if (!file.starts_with(element_prefix) || !file.ends_with(enable_suffix)) {
            return;
        }
        file.remove_prefix(element_prefix.size());
        file.remove_suffix(enable_suffix.size());
        if (count == names.size() || !set(names[count], file)) {
            fault.error = IioError::scan_layout;
            return;
        }
        ++count;
    }
    void take_entries(std::span<const char> entries) {
        constexpr std::size_t length_place = 16;  // of struct linux_dirent64: inode, offset, length, type, name
        constexpr std::size_t name_place = 19;
        while (entries.size() > name_place) {
            std::uint16_t length = 0;
            std::memcpy(&length, entries.data() + length_place, sizeof length);
            if (length <= name_place || length > entries.size()) {
                return;
            }
            const std::string_view name(entries.data() + name_place, length - name_place);
            take(name.substr(0, name.find('\0')));
            entries = entries.subspan(length);
        }
    }
};

ChannelNames list_channels(const Path& folder) {
    ChannelNames channels;
    channels.fault.file = folder;
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) {
        channels.fault.number = errno;
        channels.fault.error = IioError::file_missing;
        return channels;
    }
    alignas(8) std::array<char, 2048> entries{};
    long bytes = 0;
    while ((bytes = syscall(SYS_getdents64, descriptor, entries.data(), entries.size())) > 0) {
        channels.take_entries(std::span(entries).first(static_cast<std::size_t>(bytes)));
    }
    ::close(descriptor);
    return channels;
}

bool is_wanted(const ChannelName& name, std::span<const ChannelName> wanted) {
    return view(name) == timestamp_name ||
           std::any_of(wanted.begin(), wanted.end(), [&](const ChannelName& other) { return other == name; });
}

Fault switch_element(const Path& folder, const ChannelName& name, bool on) {
    Fault fault;
    fault.file = folder.file(element_prefix).append(view(name)).append(enable_suffix);
    fault.error = write_attribute(fault.file, on ? 1 : 0, fault.number);
    return fault;
}

Fault read_integer(const Path& path, std::int64_t& value) {
    const Attribute attribute = read_attribute(path);
    return {attribute.error == IioError::none ? parse(attribute.view(), value) : attribute.error, attribute.number,
            path};
}

}  // namespace

std::string_view view(const ChannelName& name) {
    return {name.data(), static_cast<std::size_t>(std::find(name.begin(), name.end(), '\0') - name.begin())};
}

bool set(ChannelName& name, std::string_view text) {
    name = {};
    if (text.empty() || text.size() >= name.size() || text.find('/') != std::string_view::npos ||
        text.find('\0') != std::string_view::npos) {
        return false;
    }
    std::copy(text.begin(), text.end(), name.begin());
    return true;
}

Fault ScanLayout::read(const Path& device, std::span<const ChannelName> wanted, bool configures) {
    *this = {};
    const Path folder = device.file("scan_elements");
    const ChannelNames channels = list_channels(folder);
    if (channels.fault.error != IioError::none) {
        return channels.fault;
    }
    for (const ChannelName& name : std::span(channels.names).first(channels.count)) {
        Fault fault;
        if (configures) {
            fault = switch_element(folder, name, is_wanted(name, wanted));
        }
        if (fault.error == IioError::none) {
            fault = take_element(folder, name);
        }
        if (fault.error != IioError::none) {
            return fault;
        }
    }
    for (const ChannelName& name : wanted) {
        if (find(view(name)) == nullptr) {
            const Path enable = folder.file(element_prefix).append(view(name)).append(enable_suffix);
            const Attribute attribute = read_attribute(enable);
            return {attribute.error == IioError::none ? IioError::channel_disabled : attribute.error, attribute.number,
                    enable};
        }
    }
    return {arrange(), 0, folder};
}

Fault ScanLayout::take_element(const Path& folder, const ChannelName& name) {
    const Path stem = folder.file(element_prefix).append(view(name));
    std::int64_t enabled = 0;
    Fault fault = read_integer(Path(stem).append(enable_suffix), enabled);
    if (fault.error != IioError::none || enabled == 0) {
        return fault;
    }
    if (count_ == elements_.size()) {
        return {IioError::scan_layout, 0, folder};
    }
    std::int64_t index = 0;
    fault = read_integer(Path(stem).append("_index"), index);
    if (fault.error != IioError::none) {
        return fault;
    }
    const Path type = Path(stem).append("_type");
    const Attribute text = read_attribute(type);
    const auto format = parse_scan_format(text.view());
    if (text.error != IioError::none || !format) {
        return {text.error == IioError::none ? IioError::scan_format : text.error, text.number, type};
    }
    if (index < 0 || index > UINT16_MAX) {
        return {IioError::scan_layout, 0, Path(stem).append("_index")};
    }
    elements_[count_++] = {name, static_cast<std::uint32_t>(index), 0, *format};
    return {};
}

IioError ScanLayout::arrange() {
    const std::span<ScanElement> used = std::span(elements_).first(count_);
    std::sort(used.begin(), used.end(), [](const auto& a, const auto& b) { return a.index < b.index; });
    const auto aligned = [](std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; };
    std::size_t largest = 1;
    for (std::size_t k = 0; k < count_; ++k) {
        if (k > 0 && used[k].index == used[k - 1].index) {
            return IioError::scan_layout;
        }
        const std::size_t bytes = used[k].format.bytes();
        bytes_ = aligned(bytes_, bytes);
        used[k].first_byte = static_cast<std::uint32_t>(bytes_);
        bytes_ += bytes;
        largest = std::max(largest, bytes);
    }
    bytes_ = aligned(bytes_, largest);
    return bytes_ == 0 || bytes_ > largest_scan_bytes ? IioError::scan_layout : IioError::none;
}

const ScanElement* ScanLayout::find(std::string_view name) const {
    const auto used = elements();
    const auto found = std::find_if(used.begin(), used.end(), [&](const auto& e) { return view(e.name) == name; });
    return found == used.end() ? nullptr : &*found;
}

}  // namespace millforce::iio
