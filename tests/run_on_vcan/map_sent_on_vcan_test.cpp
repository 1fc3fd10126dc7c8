// SPDX-License-Identifier: Apache-2.0
#include "live_bench.hpp"

#include "firmware/tool_checksum.hpp"
#include "firmware_can/way_over_bus.hpp"
#include "override_frame/override_frame.hpp"
#include "parameters/parameter_files.hpp"
#include "part_map/part_map_file.hpp"
#include "program_status/tool_frame.hpp"
#include "socketcan/can_socket.hpp"

#include <CppUTest/TestHarness.h>

#include <atomic>
#include <thread>

using namespace millforce;
using namespace millforce::vcan;

namespace {

/// A chip at the other end of the bus: its window alone.
class Chip {
  public:
    explicit Chip(const firmware::Parameters<float>& parameters)
        : window_(parameters, firmware::tool_checksum(parameters.tool), override_frame::default_node_id),
          thread_([this] { run(); }) {}
    ~Chip() { end(); }
    Chip(const Chip&) = delete;
    Chip& operator=(const Chip&) = delete;

    void end() {
        is_over_ = true;
        if (thread_.joinable()) {
            thread_.join();
        }
    }
    /// After end().
    [[nodiscard]] std::size_t room() const { return window_.room(); }

  private:
    void run() {
        socketcan::CanSocketSettings settings;
        (void)settings.set_interface("vcan0");
        socketcan::CanSocket socket(settings);
        while (!is_over_) {
            socket.wait(1000);
            socket.poll(socketcan::monotonic_us());
            socketcan::ReceivedFrame received;
            while (socket.receive(received)) {
                window_.on_frame(received.frame);
                hal::CanFrame answer;
                while (window_.take_frame(answer)) {
                    socket.send(answer);
                }
            }
        }
    }

    firmware::WayOverBus<float> window_;
    std::atomic<bool> is_over_{false};
    std::thread thread_;
};

/// Two blocks in air: with the end five records.
void write_map(const LiveFolder& folder, const firmware::ToolParameters<float>& tool) {
    host::PartMap map(3);
    for (std::size_t k = 0; k < map.size(); ++k) {
        map[k].path_mm = 10.0 * static_cast<double>(k);
        map[k].block_end_mm = k < 2 ? map[k].path_mm + 10.0 : map[k].path_mm;
        map[k].line = k < 2 ? k + 1 : k;
        map[k].programmed_feed_mm_s = k == 0 ? 10.0 : 20.0;
        map[k].spindle_speed_rad_s = 400.0;
    }
    host::write_part_map(folder.file("part.map"), {host::origin_of({}, "tool", tool), map});
}

std::string hex_of(const hal::CanFrame& frame) {
    std::string hex;
    for (const std::uint8_t byte : frame.data) {
        hex += fmt::format("{:02X}", byte);
    }
    return hex;
}

std::vector<std::string> send_words(const LiveFolder& folder) {
    return {"map",       "send",
            "vcan0",     folder.file("part.map"),
            "--machine", folder.file("machine.toml"),
            "--tool",    folder.file("tool.toml")};
}

}  // namespace

TEST_GROUP(MapSentOnVcan) {
    LiveFolder folder;
    firmware::Parameters<float> parameters =
        host::read_parameters(folder.file("machine.toml"), folder.file("tool.toml"));

    void setup() override {
        write_map(folder, parameters.tool);
    }
};

TEST(MapSentOnVcan, a_chip_takes_the_whole_of_a_short_map) {
    Chip chip(parameters);
    test::Program sender(send_words(folder));
    CHECK(sender.prints("the controller takes the map", patience));
    std::this_thread::sleep_for(std::chrono::seconds(1));
    sender.interrupt(SIGINT);
    sender.wait();
    chip.end();
    STRCMP_EQUAL("", sender.error().c_str());
    LONGS_EQUAL(0, sender.exit_code());
    UNSIGNED_LONGS_EQUAL(61, chip.room());  // of three stretches, and two blocks
}

TEST(MapSentOnVcan, with_tools_by_number_the_map_of_the_tool_that_the_cnc_tells_is_sent) {
    std::filesystem::create_directories(folder.file("tools"));
    folder.write("tools/T7.toml",
                 test::with(folder.text("tool.toml"), "tooth_force_limit_N = 700", "tooth_force_limit_N = 500"));
    folder.write("tools/T12.toml", folder.text("tool.toml"));
    host::write_part_map(folder.file("T12.map"), {host::origin_of({}, "T12", parameters.tool),
                                                  host::read_part_map(folder.file("part.map")).map});
    Chip chip(parameters);
    const Child cnc("cangen vcan0 -g 20 -I 2FD -L 8 -D " + hex_of(program_status::encode_tool(12, 0x2FD)));
    test::Program sender({"map", "send", "vcan0", folder.file("T12.map"), "--machine", folder.file("machine.toml"),
                          "--tools", folder.file("tools")});
    CHECK(sender.prints("5 records, 20.0 mm, to node 126, with T12", patience));
    CHECK(sender.prints("vcan0: T12\n", patience));
    CHECK(sender.prints("the controller takes the map", patience));
    std::this_thread::sleep_for(std::chrono::seconds(1));
    sender.interrupt(SIGINT);
    sender.wait();
    chip.end();
    LONGS_EQUAL(0, sender.exit_code());
    UNSIGNED_LONGS_EQUAL(61, chip.room());
}

TEST(MapSentOnVcan, another_tool_and_silence_are_told_and_give_exit_code_1) {
    {
        firmware::Parameters<float> other = parameters;
        other.tool.tooth_force_limit_N *= 2.0F;
        Chip chip(other);
        test::Program sender(send_words(folder));
        CHECK(sender.prints("refused: the controller's tool has other parameters", patience));
        sender.interrupt(SIGTERM);
        sender.wait();
        LONGS_EQUAL(1, sender.exit_code());
    }
    test::Program sender(send_words(folder));
    CHECK(sender.prints("5 records, 20.0 mm, to node 126", patience));
    sender.interrupt(SIGINT);
    sender.wait();
    LONGS_EQUAL(1, sender.exit_code());
}
