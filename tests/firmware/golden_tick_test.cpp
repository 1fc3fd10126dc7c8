// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>

#include "estimation/number/fixed_point.hpp"
#include "firmware/parameters_in.hpp"
#include "firmware/tick.hpp"
#include "instructions/synthetic_cut.hpp"

#include <CppUTest/TestHarness.h>

// The same cut on the host, on 64-bit Arm and on each Cortex-M must give the same bits: what is proven on one of them
// holds on all. On the host the test writes the vector into its build tree, on a target it compares with the vector of
// the release build, so that one must have run before: build/release/tests/test_firmware -g GoldenTick

using namespace millforce;
using estimation::Fixed;

namespace {

/// All the digits that distinguish one value from its neighbours.
std::string digits_of(float value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.9g", static_cast<double>(value));
    return text;
}
std::string digits_of(Fixed value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%lld", static_cast<long long>(value.raw()));
    return text;
}

template <typename Scalar>
std::string row_of(int sample, const firmware::ForceControlTick<Scalar>& tick) {
    const auto& e = tick.estimate();
    std::string row = std::to_string(sample);
    for (const Scalar value : {tick.control().ratio, e.tangential_N.value, e.tangential_N.variance, e.feed_N.value,
                               e.engagement.radial_immersion, e.engagement.radial_immersion_sd,
                               e.engagement.axial_depth_mm, e.engagement.axial_depth_sd_mm, e.tooth_force_N.value}) {
        row += ',' + digits_of(value);
    }
    return row + '\n';
}

constexpr const char* header =
    "sample,override,tangential_N,tangential_variance_N2,feed_N,radial_immersion,radial_immersion_sd,axial_depth_mm,"
    "axial_depth_sd_mm,tooth_force_N\n";

template <typename Scalar>
std::string table_of_the_cut() {
    const auto parameters = instructions::machine_and_tool();
    firmware::ForceControlTick<Scalar> tick(firmware::parameters_in<Scalar>(parameters));
    std::string table = header;
    constexpr int interval = 10;
    for (int sample = 0; sample < instructions::fast_widening_cut.samples(); ++sample) {
        firmware::step_and_work(tick, instructions::sample_of(sample, parameters), instructions::program_at(sample));
        if (sample % interval == 0) {
            table += row_of(sample, tick);
        }
    }
    CHECK(tick.estimate().engagement.immersion_valid);
    return table;
}

std::string contents_of(const std::string& path) {
    std::string text;
    if (std::FILE* file = std::fopen(path.c_str(), "rb")) {
        char part[512];
        for (std::size_t count = 0; (count = std::fread(part, 1, sizeof(part), file)) > 0;) {
            text.append(part, count);
        }
        std::fclose(file);
    }
    return text;
}

void write(const std::string& path, const std::string& text) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    CHECK(file != nullptr);
    std::fwrite(text.data(), 1, text.size(), file);
    std::fclose(file);
}

void check_with_host(const char* name, const std::string& table) {
    const std::string path = std::string(MILLFORCE_GOLDEN_FOLDER) + "/" + name;
    if constexpr (MILLFORCE_IS_HOST) {
        write(path, table);
    }
    const std::string golden = contents_of(path);
    CHECK_FALSE_TEXT(golden.empty(),
                     (path + " is missing: run build/release/tests/test_firmware -g GoldenTick first").c_str());
    std::size_t begin = 0;
    while (begin < table.size()) {
        const std::size_t end = table.find('\n', begin) + 1;
        STRCMP_EQUAL_TEXT(golden.substr(begin, end - begin).c_str(), table.substr(begin, end - begin).c_str(), name);
        begin = end;
    }
    UNSIGNED_LONGS_EQUAL(golden.size(), table.size());
}

}  // namespace

TEST_GROUP(GoldenTick){};

TEST(GoldenTick, gives_the_same_bits_on_every_processor_in_float) {
    check_with_host("tick_float.csv", table_of_the_cut<float>());
}

TEST(GoldenTick, gives_the_same_bits_on_every_processor_in_fixed_point) {
    check_with_host("tick_fixed.csv", table_of_the_cut<Fixed>());
}
