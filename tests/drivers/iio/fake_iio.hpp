// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "iio/adc_currents.hpp"
#include "temporary_folder.hpp"

/// A folder that looks as a device of Linux IIO does, with a FIFO in the place of /dev/iio:device0.

namespace millforce::iio::test {

class FakeTree {
  public:
    void write(const std::string& file, const std::string& text) const {
        const std::filesystem::path path = folder_.path(file);
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path) << text;
    }
    [[nodiscard]] std::string read(const std::string& file) const {
        std::string line;
        std::ifstream in(folder_.path(file));
        std::getline(in, line);
        return line;
    }
    void remove(const std::string& file) const { std::filesystem::remove_all(folder_.path(file)); }
    [[nodiscard]] Path path(const std::string& file) const { return Path(name(file)); }
    [[nodiscard]] std::string name(const std::string& file) const { return folder_.path(file).string(); }

  private:
    millforce::test::TemporaryFolder folder_;
};

/// Two 12-bit channels, voltage0 and voltage3, and a timestamp: 16 bytes a scan.
class FakeAdc : public FakeTree {
  public:
    FakeAdc() {
        element("voltage0", 0, "le:u12/16>>0");
        element("voltage1", 1, "le:u12/16>>0");
        element("voltage3", 3, "be:s12/16>>4");
        element("timestamp", 4, "le:s64/64>>0");
        write("device/in_voltage_scale", "0.805664062\n");  // 3.3 V over 4096
        write("device/in_voltage3_scale", "1.0\n");
        write("device/in_voltage0_offset", "-2048\n");
        write("device/buffer/enable", "0\n");
        write("device/buffer/length", "2\n");
        write("device/current_timestamp_clock", "monotonic\n");
        mkfifo(name("buffer").c_str(), 0600);
        writer_ = ::open(name("buffer").c_str(), O_RDWR | O_NONBLOCK);
    }
    ~FakeAdc() { close(writer_); }
    FakeAdc(const FakeAdc&) = delete;
    FakeAdc& operator=(const FakeAdc&) = delete;

    void element(const std::string& channel, int index, const std::string& type, const std::string& enabled = "0") {
        const std::string stem = "device/scan_elements/in_" + channel;
        write(stem + "_en", enabled + "\n");
        write(stem + "_index", std::to_string(index) + "\n");
        write(stem + "_type", type + "\n");
    }
    void put(const std::vector<std::uint8_t>& bytes) const {
        if (::write(writer_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
            std::abort();
        }
    }
    /// A scan as the device lays it out: voltage0, voltage3, four bytes of nothing, the time.
    static std::vector<std::uint8_t> scan(unsigned first, int third, std::int64_t time_ns) {
        const auto shifted = static_cast<unsigned>(third) << 4U;
        std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(first),
                                        static_cast<std::uint8_t>(first >> 8U),
                                        static_cast<std::uint8_t>(shifted >> 8U),
                                        static_cast<std::uint8_t>(shifted),
                                        0xEE,
                                        0xEE,
                                        0xEE,
                                        0xEE};
        for (unsigned k = 0; k < 8; ++k) {
            bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(time_ns) >> (8U * k)));
        }
        return bytes;
    }

    /// Spindle on voltage0: a Hall sensor, 10 A per V; x on voltage3: a drive's monitor, 2 A per V around 0.5 V.
    [[nodiscard]] AdcSettings settings() const {
        AdcSettings settings;
        settings.device = path("device");
        settings.buffer = path("buffer");
        set(settings.channels[0].name, "voltage0");
        settings.channels[0].A_per_V = 10.0F;
        settings.channels[0].largest_A = 100.0F;
        set(settings.channels[1].name, "voltage3");
        settings.channels[1].A_per_V = -2.0F;
        settings.channels[1].zero_V = 0.5F;
        settings.channels[1].largest_A = 4.0F;
        settings.sample_period_us = 100;
        settings.configures = true;
        settings.buffer_scans = 1024;
        settings.stale_us = 20'000;
        return settings;
    }

  private:
    int writer_ = -1;
};

}  // namespace millforce::iio::test
