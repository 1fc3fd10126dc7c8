// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/if.h>
#include <linux/tty.h>
#include <sys/ioctl.h>
#include <termios.h>

#include <atomic>
#include <mutex>
#include <string>
#include <thread>

#include "bus_peers.hpp"

namespace millforce::vcan {

/// A CAN controller whose errors can be made: the kernel's serial-line driver (slcan) on a pseudo terminal, at whose
/// other end we play the adapter. The kernel sees a CAN interface with fault confinement.
class SerialLineCan {
  public:
    SerialLineCan() {
        adapter_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
        grantpt(adapter_);
        unlockpt(adapter_);
        std::array<char, 64> name{};
        ptsname_r(adapter_, name.data(), name.size());
        line_ = open(name.data(), O_RDWR | O_NOCTTY);
        make_raw(adapter_);
        make_raw(line_);
        reader_ = std::thread([this] { read_until_closed(); });
        const int discipline = N_SLCAN;
        ioctl(line_, TIOCSETD, &discipline);
        ifreq request{};
        is_there_ = ioctl(line_, SIOCGIFNAME, &request) == 0;
        name_ = request.ifr_name;
        // The driver makes its interface in the first network namespace.
        shell("nsenter --net=/proc/1/ns/net ip link set " + name_ + " netns " + std::to_string(getpid()));
        shell("ip link set " + name_ + " type can bitrate 500000");
        is_there_ = is_there_ && shell("ip link set " + name_ + " up") == 0;
    }
    ~SerialLineCan() {
        close(line_);
        closing_ = true;
        reader_.join();
        close(adapter_);
    }
    SerialLineCan(const SerialLineCan&) = delete;
    SerialLineCan& operator=(const SerialLineCan&) = delete;

    /// A line of the adapter's protocol, e.g. `t1232AABB`, or `sw096127`: state warning, 96 and 127 errors.
    void say(const std::string& line) const {
        const std::string bytes = line + "\r";
        if (write(adapter_, bytes.data(), bytes.size()) < 0) {
            std::perror("adapter");
        }
    }
    /// What the kernel wrote to the adapter until now.
    [[nodiscard]] std::string heard() {
        const std::lock_guard lock(mutex_);
        return heard_;
    }
    [[nodiscard]] bool is_there() const { return is_there_; }
    [[nodiscard]] const std::string& name() const { return name_; }

  private:
    static void make_raw(int descriptor) {
        termios settings{};
        tcgetattr(descriptor, &settings);
        cfmakeraw(&settings);
        tcsetattr(descriptor, TCSANOW, &settings);
    }

    /// The driver waits for each of its commands to be taken: setting the interface up needs a listener.
    void read_until_closed() {
        std::array<char, 4096> bytes{};
        while (!closing_) {
            const ssize_t count = read(adapter_, bytes.data(), bytes.size());
            if (count <= 0) {
                sleep_ms(1);
                continue;
            }
            const std::lock_guard lock(mutex_);
            heard_.append(bytes.data(), static_cast<std::size_t>(count));
        }
    }

    int adapter_ = -1;
    int line_ = -1;
    bool is_there_ = false;
    std::string name_{};
    std::atomic<bool> closing_ = false;
    std::mutex mutex_{};
    std::string heard_{};
    std::thread reader_{};
};

}  // namespace millforce::vcan
