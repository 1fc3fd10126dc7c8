// SPDX-License-Identifier: Apache-2.0
#include "firmware/program/import/import_bench.hpp"
#include "recording/recording.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

using namespace millforce::host;
using namespace millforce::test;

namespace {

struct Example {
    const char* source;
    const char* map;
    Resampling resampling;
    double step_s;
};

/// All of one invented cut: a spindle at 4000 rpm with 6 A on average, X at 20 mm/s with 3 A.
const std::vector<Example> examples{{"table.csv", "table.toml", {}, 0.001},
                                    {"odrive.csv", "odrive.toml", {}, 0.002},
                                    {"sinumerik.xml", "sinumerik.toml", {}, 0.002},
                                    {"halsampler.txt", "halsampler.toml", {}, 0.001},
                                    {"candump.log", "candump.toml", {1000.0, 0.02}, 0.001}};

const ColumnStatistics& statistics_of(const ImportedRecording& recording, std::string_view name) {
    for (std::size_t k = 0; k < recording.columns.size(); ++k) {
        if (recording.columns[k].column.name == name) {
            return recording.statistics[k];
        }
    }
    throw std::runtime_error("no such column");
}

const std::string table_map = R"([time_s]
source = "t"
unit = "ms"
[spindle_angle_rad]
source = "a"
unit = "deg"
wrap = 360
[x_current_A]
source = "i"
[x_velocity_mm_s]
source = "v"
)";

/// A cut at 3000 rpm, rows of 1 ms.
std::string table_of(int rows) {
    std::string text = "t,a,i,v\n";
    for (int k = 0; k < rows; ++k) {
        text += std::to_string(k) + "," + std::to_string(18 * k % 360) + ",2,15\n";
    }
    return text;
}

}  // namespace

TEST_GROUP(ImportRecording) {
    ImportBench bench;

    ImportedRecording import_example(const Example& example) {
        ImportSettings settings;
        settings.files = {example_folder + example.source};
        settings.map = example_folder + example.map;
        settings.output = bench.path("out.csv").string();
        settings.resampling = example.resampling;
        return import_recording(settings);
    }
    std::string report(std::string_view text, const std::string& map) {
        return import_report(bench.import(text, map));
    }
};

TEST(ImportRecording, every_format_gives_the_speed_the_feed_and_the_currents_of_the_cut) {
    for (const Example& example : examples) {
        const ImportedRecording recording = import_example(example);
        const ColumnStatistics& angle = statistics_of(recording, "spindle_angle_rad");
        const double speed_rpm = angle.change() / recording.steps.duration_s() * 30.0 / std::numbers::pi;
        DOUBLES_EQUAL(4000.0, speed_rpm, 60.0);
        LONGS_EQUAL(0, angle.falls());
        DOUBLES_EQUAL(20.0, statistics_of(recording, "x_velocity_mm_s").mean(), 0.01);
        DOUBLES_EQUAL(6.0, statistics_of(recording, "spindle_current_A").mean(), 0.05);
        DOUBLES_EQUAL(3.0, statistics_of(recording, "x_current_A").mean(), 0.05);
        DOUBLES_EQUAL(1.0 / example.step_s, recording.steps.rate_hz(), 0.01 / example.step_s);
        CHECK(!contains(import_report(recording), "implausible"));
    }
}

TEST(ImportRecording, every_format_gives_what_a_replay_reads) {
    for (const Example& example : examples) {
        import_example(example);
        RecordingReader reader(bench.path("out.csv"), 8192);
        std::size_t rows = 0;
        std::size_t rows_of_x = 0;
        while (reader.next()) {
            ++rows;
            rows_of_x += (reader.sample().present & millforce::hal::axis_mask(0)) != 0 ? 1U : 0U;
        }
        CHECK(rows >= 55);
        CHECK(rows_of_x >= rows - 8);
    }
}

TEST(ImportRecording, begins_at_0_and_keeps_the_steps_to_the_nanosecond) {
    bench.import("t,a,i,v\n1000.25,0,1,1\n1001.25,20,1,1\n1002.2501,40,1,1\n", table_map);
    STRCMP_EQUAL("0 0.001 0.0020001", joined(bench.column("time_s")).c_str());
}

TEST(ImportRecording, goes_on_from_file_to_file) {
    const auto recording = bench.import_parts({"t,a,i,v\n0,350,1,1\n1,355,1,1\n", "v,i,a,t\n1,2,5,2\n"}, table_map);
    STRCMP_EQUAL("0 0.001 0.002", joined(bench.column("time_s")).c_str());
    STRCMP_EQUAL("1 1 2", joined(bench.column("x_current_A")).c_str());
    DOUBLES_EQUAL(15.0 * std::numbers::pi / 180.0, statistics_of(recording, "spindle_angle_rad").change(), 1e-12);
}

TEST(ImportRecording, counts_samples_on_from_file_to_file) {
    const std::string map = "[time_s]\nrate_hz = 10\n[x_current_A]\nsource = \"i\"\n";
    bench.import_parts({"i\n1\n2\n", "i\n3\n"}, map);
    STRCMP_EQUAL("0 0.1 0.2", joined(bench.column("time_s")).c_str());
}

TEST(ImportRecording, resamples_only_where_it_is_asked_to) {
    const std::string text = "t,a,i,v\n0,0,1,1\n1,5,2,1\n3,10,3,1\n4,15,4,1\n";
    bench.import(text, table_map);
    STRCMP_EQUAL("0 0.001 0.003 0.004", joined(bench.column("time_s")).c_str());
    bench.import(text, table_map, {500.0, 0.01});
    STRCMP_EQUAL("0 0.002 0.004", joined(bench.column("time_s")).c_str());
    STRCMP_EQUAL("1 2 4", joined(bench.column("x_current_A")).c_str());
}

TEST(ImportRecording, resamples_what_comes_late_at_its_own_time) {
    std::string text = "t,x\n";
    for (int k = 0; k < 100; ++k) {
        text += std::to_string(k) + "," + std::to_string(0.03 * k) + "\n";
    }
    const std::string map =
        "[time_s]\nsource = \"t\"\nunit = \"ms\"\n[x_current_A]\nsource = \"t\"\n"
        "[x_velocity_mm_s]\nsource = \"x\"\nderived_from = \"position\"\nsmoothing_s = 0.01\n";
    const auto recording = bench.import(text, map, {500.0, 0.001});
    const auto rows = bench.rows();
    LONGS_EQUAL(50, rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        LONGS_EQUAL(2 * k, std::stoul(rows[k].at("x_current_A")));
    }
    DOUBLES_EQUAL(30.0, statistics_of(recording, "x_velocity_mm_s").mean(), 1e-9);
}

TEST(ImportRecording, makes_the_angle_of_a_speed_or_of_index_pulses_where_there_is_no_encoder) {
    // 3000 rpm, backwards in the source: 20 rows a turn, the pulse high in two of them.
    std::string text = "t,n,index\n";
    for (int k = 0; k < 200; ++k) {
        text += std::to_string(k) + ",-3000," + (k % 20 < 2 ? "24" : "0.2") + "\n";
    }
    const std::string time = "[time_s]\nsource = \"t\"\nunit = \"ms\"\n[spindle_angle_rad]\n";
    const std::string of_speed = time + "source = \"n\"\nderived_from = \"speed\"\nunit = \"rpm\"\nsign = -1\n";
    const std::string of_index = time + "source = \"index\"\nderived_from = \"index\"\nthreshold = 12\n";
    constexpr double turn_rad = 2.0 * std::numbers::pi;
    const auto by_speed = bench.import(text, of_speed);
    DOUBLES_EQUAL(199.0 / 20.0 * turn_rad, by_speed.statistics[0].change(), 1e-6);
    const auto by_index = bench.import(text, of_index);
    // From the first edge, in row 20, to before the last one, in row 180.
    LONGS_EQUAL(160, by_index.statistics[0].count());
    DOUBLES_EQUAL(159.0 / 20.0 * turn_rad, by_index.statistics[0].change(), 1e-9);
    CHECK(contains(import_report(by_index), "pulse above 12"));
}

TEST(ImportRecording, refuses_times_that_do_not_grow_and_names_the_line) {
    CHECK(contains(bench.error("t,a,i,v\n0,0,1,1\n1,1,1,1\n1,2,1,1\n", table_map),
                   "source0:4: time_s: 0.001 s after 0.001 s, expected a time that grows"));
    CHECK(contains(bench.error("t,a,i,v\n0,0,1,1\n-1,1,1,1\n", table_map), "source0:3: time_s: -0.001 s after 0 s"));
    CHECK(contains(bench.error("t,a,i,v\n0,0,1,1\nnan,1,1,1\n", table_map), "source0:3: time_s: no time"));
}

TEST(ImportRecording, refuses_samples_without_a_time_or_a_rate) {
    CHECK(contains(bench.error("i\n1\n", "[x_current_A]\nsource = \"i\"\n"),
                   "map.toml: time_s: missing, expected [time_s] with source, or with rate_hz"));
}

TEST(ImportRecording, refuses_a_time_that_does_not_fit_its_wrap) {
    const std::string map = "[time_s]\nsource = \"t\"\nwrap = 10\n[x_current_A]\nsource = \"i\"\n";
    CHECK(contains(bench.error("t,i\n0,1\n11,1\n", map),
                   "source0:3: time_s: 11 after 0, expected values that begin again at wrap = 10"));
}

TEST(ImportRecording, takes_the_format_asked_for_before_what_the_map_says) {
    ImportSettings settings;
    settings.files = {bench.write("a.csv", table_of(3)).string()};
    settings.map = bench.write("map.toml", table_map + "[source]\nformat = \"csv\"\n").string();
    settings.format = SourceFormat::sinumerik;
    CHECK(contains(message_of<InputError>([&] { static_cast<void>(import_recording(settings)); }), "no <dataFrame>"));
}

TEST(ImportRecording, needs_a_map_for_signals_with_names_of_their_own) {
    const std::string trace =
        "<a><dataFrame><dataSignal id=\"f1\" name=\"vel\"/><rec time=\"0\" f1=\"1\"/></dataFrame></a>";
    CHECK(contains(bench.error(trace, ""), "names of their own; expected --map; there are vel"));
    CHECK(contains(bench.error("(1.0) can0 181#0A00\n", ""), "names of their own; expected --map"));
}

TEST(ImportRecording, names_no_more_than_a_few_of_the_columns_that_it_does_not_use) {
    std::string names = "time_s,x_current_A,same,same,";
    std::string cells = "0,1,0,0,0";
    for (int k = 0; k < 200; ++k) {
        names += ",c" + std::to_string(k);
        cells += ",0";
    }
    const auto recording = bench.import(names + "\n" + cells + "\n", "");
    STRCMP_EQUAL("same", recording.unused_names[0].c_str());
    STRCMP_EQUAL("c0", recording.unused_names[1].c_str());
    CHECK(recording.unused_names.size() < 200);
}

TEST(ImportRecording, refuses_an_angle_that_does_not_fit_its_wrap) {
    CHECK(contains(bench.error("t,a,i,v\n0,0,1,1\n1,400,1,1\n", table_map),
                   "source0:3: spindle_angle_rad: 400 after 0, expected values that begin again at wrap = 360"));
}

TEST(ImportRecording, writes_nothing_where_the_last_row_is_wrong) {
    CHECK(!bench.error(table_of(1000) + "1000,x,1,1\n", table_map).empty());
    CHECK(!std::filesystem::exists(bench.path("out.csv")));
    LONGS_EQUAL(2, bench.file_count());
}

TEST(ImportRecording, does_not_overwrite_what_it_reads) {
    ImportSettings settings;
    settings.files = {bench.write("a.csv", table_of(3)).string()};
    settings.map = bench.write("map.toml", table_map).string();
    settings.output = settings.files[0];
    CHECK(contains(message_of<InputError>([&] { static_cast<void>(import_recording(settings)); }),
                   "is the file to import"));
    STRCMP_EQUAL(table_of(3).c_str(), bench.read("a.csv").c_str());
}

TEST(ImportRecording, reports_what_it_understood) {
    const std::string text = report(table_of(200), table_map);
    CHECK(contains(text, "table separated by ',', names in line 1"));
    CHECK(contains(text, "200 rows, 0.199 s, 1000 Hz; steps vary by 0 % (rms); no gaps"));
    CHECK(contains(text, "spindle_angle_rad  a       deg, wraps at 360           0"));
    CHECK(contains(text, "x_velocity_mm_s    v       mm/s                       15          15          15        0"));
    CHECK(contains(text, "not there: spindle_current_A, y_current_A, z_current_A, y_velocity_mm_s, z_velocity_mm_s"));
    CHECK(!contains(text, "implausible"));
}

TEST(ImportRecording, names_implausible_ranges_with_the_likely_mistake) {
    const std::string table = table_of(200);
    const auto doubt = [&](const std::string& from, const std::string& to) {
        return report(table, with_text(table_map, from, to));
    };
    CHECK(contains(doubt("\"v\"", "\"v\"\nscale = 200"),
                   "x_velocity_mm_s reaches 3000, more than 2 m/s; its unit is "
                   "\"mm/s\": is it mm/min"));
    CHECK(contains(doubt("\"i\"", "\"i\"\nscale = 1000"),
                   "x_current_A reaches 2000, more than 500 A; its unit is \"A\": is it mA"));
    CHECK(contains(doubt("wrap = 360", ""),
                   "spindle_angle_rad falls back 9 times, by up to 5.969 rad: does it begin "
                   "again there (wrap)?"));
    CHECK(contains(doubt("wrap = 360", "wrap = 360\nsign = -1"), "is it sign = -1?"));
    CHECK(contains(doubt("unit = \"deg\"", "unit = \"rad\""), "turns at 1.72e+05 rpm; its unit is \"rad\": is it deg"));
    CHECK(contains(doubt("unit = \"ms\"", "unit = \"s\""),
                   "1 rows per second: too slow to see a tooth; is the unit of "
                   "time ms"));
    CHECK(contains(doubt("unit = \"ms\"", "unit = \"ns\""), "1e+09 rows per second: is the unit of time s?"));
    CHECK(contains(doubt("\"v\"", "\"v\"\nderived_from = \"position\"\nsmoothing_s = 0.001"),
                   "x_velocity_mm_s has no value at all: is smoothing_s shorter"));
}

TEST(ImportRecording, names_the_likely_mistake_of_each_unit) {
    const std::string table = table_of(200);
    const auto doubt = [&](const std::string& from, const std::string& to) {
        return report(table, with_text(table_map, from, to));
    };
    CHECK(contains(doubt("\"v\"", "\"v\"\nunit = \"m/s\""), "its unit is \"m/s\": is it m/min or mm/s?"));
    CHECK(contains(doubt("\"v\"", "\"v\"\nunit = \"m/min\"\nscale = 10"), "is it mm/min or mm/s?"));
    CHECK(
        contains(doubt("\"v\"", "\"v\"\nunit = \"in/min\"\nscale = 1000"), "is it right, and what it is divided by?"));
    CHECK(contains(doubt("\"v\"", "\"t\"\nderived_from = \"position\"\nunit = \"mm\"\nscale = 5"),
                   "is it mm or counts, and does the position begin again somewhere (wrap)?"));
    CHECK(contains(doubt("\"i\"", "\"i\"\nunit = \"rated\"\nrated_A = 400"), "is it % or permille?"));
    CHECK(
        contains(doubt("\"i\"", "\"i\"\nunit = \"%\"\nrated_A = 400\nscale = 100"), "is it permille, and is rated_A"));
    CHECK(contains(doubt("\"i\"", "\"i\"\nunit = \"permille\"\nrated_A = 400\nscale = 1000"),
                   "is it right, and rated_A?"));
    CHECK(contains(doubt("\"i\"", "\"i\"\n[fx_N]\nsource = \"v\"\nscale = 10000"), "more than 100 kN"));
    CHECK(contains(doubt("\"i\"", "\"i\"\n[override]\nsource = \"v\""), "override reaches 15, more than 3"));
    CHECK(contains(doubt("\"a\"", "\"i\""), "spindle_angle_rad does not change: is it another column?"));
    CHECK(contains(doubt("unit = \"deg\"\nwrap = 360", "derived_from = \"index\"\nthreshold = 900"),
                   "is the threshold right"));
}

TEST(ImportRecording, takes_what_the_cnc_tells_of_its_program) {
    const std::string table =
        "t,F,G,S\n"
        "0,1200,0,6000\n"
        "1,1200,1,6000\n"
        "2,1500,1,\n";
    const std::string map =
        "[time_s]\nsource = \"t\"\nunit = \"ms\"\n"
        "[programmed_feed_mm_s]\nsource = \"F\"\nunit = \"mm/min\"\n"
        "[rapid]\nsource = \"G\"\nequals = 0\n"
        "[commanded_speed_rad_s]\nsource = \"S\"\nunit = \"rpm\"\n";
    const std::string text = report(table, map);
    STRCMP_EQUAL("20 20 25", joined(bench.column("programmed_feed_mm_s")).c_str());
    STRCMP_EQUAL("1 0 0", joined(bench.column("rapid")).c_str());
    const std::vector<std::string> speed = bench.column("commanded_speed_rad_s");
    DOUBLES_EQUAL(200.0 * std::numbers::pi, std::stod(speed.at(1)), 1e-6);
    STRCMP_EQUAL("", speed.at(2).c_str());
    CHECK(contains(text, "1 where it is 0"));
    CHECK(!contains(text, "implausible: rapid"));
}

TEST(ImportRecording, takes_a_state_for_set_above_its_threshold) {
    const auto rapid_of = [&](const std::string& rest) {
        bench.import("t,r\n0,0\n1,1\n2,2\n",
                     "[time_s]\nsource = \"t\"\nunit = \"ms\"\n[rapid]\nsource = \"r\"\n" + rest);
        return joined(bench.column("rapid"));
    };
    STRCMP_EQUAL("0 1 1", rapid_of("").c_str());
    STRCMP_EQUAL("0 0 1", rapid_of("threshold = 1.5\n").c_str());
}

TEST(ImportRecording, doubts_a_feed_or_a_commanded_speed_that_cannot_be) {
    const auto doubt = [&](const std::string& column) { return report(table_of(200), table_map + column); };
    CHECK(contains(doubt("[programmed_feed_mm_s]\nsource = \"v\"\nsign = -1\n"),
                   "programmed_feed_mm_s falls to -15, expected nothing below 0: is it sign = -1?"));
    CHECK(contains(doubt("[programmed_feed_mm_s]\nsource = \"v\"\nscale = 200\n"), "is it mm/min?"));
    CHECK(contains(doubt("[commanded_speed_rad_s]\nsource = \"v\"\nsign = -1\n"),
                   "commanded_speed_rad_s falls to -15, expected nothing below 0"));
    CHECK(contains(doubt("[commanded_speed_rad_s]\nsource = \"v\"\nscale = 1000\n"), "is it rpm?"));
    CHECK(!contains(doubt("[programmed_feed_mm_s]\nsource = \"v\"\n[commanded_speed_rad_s]\nsource = \"v\"\n"),
                    "implausible"));
}

TEST(ImportRecording, takes_plausible_forces_and_overrides_without_a_word) {
    const std::string map = table_map + "[fx_N]\nsource = \"v\"\n[override]\nsource = \"v\"\nunit = \"%\"\n";
    CHECK(!contains(report(table_of(200), map), "implausible"));
}

TEST_GROUP(RecordingStatistics){};

TEST(RecordingStatistics, tell_a_gap_from_uneven_steps) {
    StepStatistics steps;
    double time_s = 0.0;
    for (int k = 0; k < 2000; ++k) {
        steps.add(time_s);
        time_s += k == 1500 ? 0.0105 : k % 2 == 0 ? 0.00101 : 0.00099;
    }
    steps.finish();
    LONGS_EQUAL(1, steps.gaps());
    DOUBLES_EQUAL(0.0105, steps.longest_gap_s(), 1e-9);
    DOUBLES_EQUAL(1.5, steps.longest_gap_at_s(), 1e-6);
    DOUBLES_EQUAL(1000.0, steps.rate_hz(), 0.1);
    DOUBLES_EQUAL(0.01, steps.unevenness(), 1e-4);
}

TEST(RecordingStatistics, draw_a_ramp_as_bars_that_rise_whatever_its_length) {
    for (const double length_s : {0.01, 1.0, 5000.0}) {
        Sparkline line;
        for (int k = 0; k < 5000; ++k) {
            line.add(length_s * k / 5000.0, k);
        }
        const std::string text = line.text();
        CHECK(text.starts_with("▁"));
        CHECK(text.ends_with("█"));
        const std::size_t bars = text.size() / 3;
        CHECK(bars >= 24 && bars <= 48);
        for (std::size_t k = 3; k < text.size(); k += 3) {
            CHECK(text.substr(k - 3, 3) <= text.substr(k, 3));
        }
    }
}

TEST(RecordingStatistics, leave_a_blank_where_there_is_no_value) {
    Sparkline line;
    for (int k = 0; k < 48; ++k) {
        line.add(k, k >= 16 && k < 32 ? std::numeric_limits<double>::quiet_NaN() : 1.0);
    }
    const std::string text = line.text();
    const auto blanks = static_cast<std::size_t>(std::count(text.begin(), text.end(), ' '));
    CHECK(blanks >= 14 && blanks <= 16);
    CHECK(contains(text, "▁" + std::string(blanks, ' ') + "▁"));
}
