// SPDX-License-Identifier: Apache-2.0
#include "firmware/program/import/import_bench.hpp"

#include <CppUTest/TestHarness.h>

#include <random>

using namespace millforce::host;
using namespace millforce::test;

namespace {

struct Hostile {
    const char* source;
    const char* map;
};

const std::vector<Hostile> sources{{"table.csv", "table.toml"},
                                   {"odrive.csv", "odrive.toml"},
                                   {"sinumerik.xml", "sinumerik.toml"},
                                   {"halsampler.txt", "halsampler.toml"},
                                   {"candump.log", "candump.toml"}};

}  // namespace

TEST_GROUP(HostileSources) {
    ImportBench bench;
    std::mt19937 random{3};

    std::size_t below(std::size_t end) {
        return random() % end;
    }

    /// A byte changed, a piece cut out or doubled, or the end cut off.
    std::string damaged(std::string text) {
        const std::size_t begin = below(text.size());
        const std::size_t length = std::min(text.size() - begin, 1 + below(40));
        switch (below(4)) {
            case 0:
                text[begin] = static_cast<char>(below(256));
                break;
            case 1:
                text.erase(begin, length);
                break;
            case 2:
                text.insert(below(text.size()), text.substr(begin, length));
                break;
            default:
                text.resize(begin);
        }
        return text;
    }

    /// True where it was refused in one line.
    bool is_refused(const Hostile& hostile, const std::string& text) {
        ImportSettings settings;
        settings.files = {bench.write("source", text).string()};
        settings.map = example_folder + hostile.map;
        settings.resampling.rate_hz = below(2) == 0 || hostile.source == sources.back().source ? 1000.0 : 0.0;
        const std::string message =
            message_of<InputError>([&] { static_cast<void>(import_report(import_recording(settings))); });
        CHECK(message.find('\n') == std::string::npos);
        return !message.empty();
    }
};

TEST(HostileSources, are_imported_or_refused_in_one_line) {
    for (const Hostile& hostile : sources) {
        std::string whole;
        {
            std::ifstream file(example_folder + hostile.source, std::ios::binary);
            std::ostringstream text;
            text << file.rdbuf();
            whole = text.str();
        }
        std::size_t refused = 0;
        for (int round = 0; round < 150; ++round) {
            std::string text = damaged(whole);
            text = below(2) == 0 ? text : damaged(text.empty() ? whole : text);
            refused += is_refused(hostile, text) ? 1U : 0U;
        }
        CHECK(refused > 10);
        CHECK(refused < 150);
    }
}

TEST(HostileSources, a_number_that_nobody_can_measure_is_refused) {
    const std::string header = "time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s,override\n";
    STRCMP_EQUAL("", bench.error(header + "0,0,3,2,10,1\n0.001,0.4,3,2,10,1\n", "").c_str());
    STRCMP_EQUAL("source0:2: override: 1e+308 is beyond anything measured; expected at most 1e+18",
                 bench.error(header + "0,0,3,2,10,1e308\n", "").c_str());
    STRCMP_EQUAL("source0:2: x_current_A: -1e+308 is beyond anything measured; expected at most 1e+18",
                 bench.error(header + "0,0,3,-1e308,10,1\n", "").c_str());
}
