// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "cnc/cnc.hpp"
#include "files/input_error.hpp"
#include "programs.hpp"

// Behind Eigen: it replaces operator new by a macro.
#include <CppUTest/TestHarness.h>

using namespace millforce::host;
using namespace millforce::sim;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

double velocity_step(const CncSettings& settings) {
    return settings.acceleration_mm_s2 * settings.servo_period_s;
}

/// Runs until `until` says so or `longest_s` have passed; the time that it took.
double run_until(Cnc& cnc, double override_ratio, double longest_s, const std::function<bool()>& until) {
    double time_s = 0.0;
    while (!until() && time_s < longest_s) {
        cnc.step(override_ratio, false);
        time_s += cnc.settings().servo_period_s;
    }
    return time_s;
}

double run_to_end(Cnc& cnc, double override_ratio = 1.0, double longest_s = 600.0) {
    const double time_s = run_until(cnc, override_ratio, longest_s, [&] { return cnc.finished(); });
    CHECK(cnc.finished());
    return time_s;
}

std::string refusal_of(const CncSettings& settings, const std::vector<Move>& moves) {
    try {
        const Cnc cnc(settings, moves);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_GROUP(CncMotion) {
    CncSettings settings;
};

TEST(CncMotion, reaches_feed_times_override_and_stays_there) {
    Cnc cnc(settings, PathBuilder(20.0).line(100.0, 0.0).moves());
    run_until(cnc, 0.7, 1.0, [] { return false; });
    DOUBLES_EQUAL(14.0, cnc.feed_mm_s(), 1e-12);
    run_until(cnc, 1.5, 0.5, [] { return false; });
    DOUBLES_EQUAL(30.0, cnc.feed_mm_s(), 1e-12);
}

TEST(CncMotion, an_override_acts_after_the_latency_and_not_before) {
    Cnc cnc(settings, PathBuilder(20.0).line(100.0, 0.0).moves());
    run_until(cnc, 1.0, 0.5, [] { return false; });
    const auto latency_steps = static_cast<int>(std::lround(settings.override_latency_s / settings.servo_period_s));
    for (int k = 0; k < latency_steps; ++k) {
        cnc.step(0.5, false);
        DOUBLES_EQUAL(20.0, cnc.feed_mm_s(), 1e-12);
    }
    cnc.step(0.5, false);
    DOUBLES_EQUAL(20.0 - velocity_step(settings), cnc.feed_mm_s(), 1e-12);
}

TEST(CncMotion, velocity_rises_and_falls_with_the_acceleration_limit) {
    Cnc cnc(settings, PathBuilder(100.0).line(100.0, 0.0).moves());
    run_until(cnc, 1.0, settings.override_latency_s + settings.servo_period_s / 2.0, [] { return false; });
    for (int k = 2; k <= 200; ++k) {
        cnc.step(1.0, false);
        DOUBLES_EQUAL(std::min(100.0, k * velocity_step(settings)), cnc.feed_mm_s(), 1e-9);
    }
}

TEST(CncMotion, ends_exactly_where_the_program_ends_at_rest) {
    for (const double feed : {0.01, 0.3, 7.77, 20.0, 200.0}) {
        const auto moves = PathBuilder(feed).line(0.3, 0.7).arc(3.0, 1.0, 2.0, 0.4).line(1.0 / 3.0, 0.1, -0.2).moves();
        Cnc cnc(settings, moves);
        double before_mm_s = 0.0;
        while (!cnc.finished()) {
            before_mm_s = cnc.feed_mm_s();
            cnc.step(1.0, false);
        }
        CHECK(cnc.position_mm() == moves.back().end_mm);
        DOUBLES_EQUAL(0.0, cnc.feed_mm_s(), 0.0);
        CHECK(before_mm_s <= velocity_step(settings) + 1e-12);
        DOUBLES_EQUAL(cnc.total_path_mm(), cnc.path_mm(), 1e-12);
    }
}

TEST(CncMotion, a_straight_move_takes_the_time_of_a_trapezoid) {
    Cnc cnc(settings, PathBuilder(50.0).line(30.0, 40.0).moves());
    const double trapezoid_s = 50.0 / 50.0 + 50.0 / settings.acceleration_mm_s2 + settings.override_latency_s;
    DOUBLES_EQUAL(trapezoid_s, run_to_end(cnc), 8.0 * settings.servo_period_s);
}

TEST(CncMotion, a_short_move_takes_the_time_of_a_triangle) {
    Cnc cnc(settings, PathBuilder(200.0).line(1.0, 0.0).moves());
    const double triangle_s = 2.0 * std::sqrt(1.0 / settings.acceleration_mm_s2) + settings.override_latency_s;
    DOUBLES_EQUAL(triangle_s, run_to_end(cnc), 8.0 * settings.servo_period_s);
}

TEST(CncMotion, corners_are_passed_at_the_speed_of_the_junction_deviation) {
    for (const double degrees : {5.0, 20.0, 45.0, 90.0, 135.0, 170.0}) {
        const double deflection = degrees * pi / 180.0;
        Cnc cnc(
            settings,
            PathBuilder(240.0).line(40.0, 0.0).line(40.0 * std::cos(deflection), 40.0 * std::sin(deflection)).moves());
        double slowest = infinite;
        run_until(cnc, 1.0, 10.0, [&] {
            if (std::abs(cnc.path_mm() - 40.0) < 5.0) {
                slowest = std::min(slowest, cnc.feed_mm_s());
            }
            return cnc.finished();
        });
        const double corner = std::min(240.0, corner_speed_mm_s(deflection, settings));
        CHECK(slowest <= corner + 1e-9);
        CHECK(slowest > corner - velocity_step(settings));
    }
}

TEST(CncMotion, straight_on_is_no_corner_and_back_is_a_stop) {
    Cnc straight(settings, PathBuilder(100.0).line(20.0, 0.0).line(20.0, 0.0).line(20.0, 0.0).moves());
    run_until(straight, 1.0, 1.0, [&] { return straight.path_mm() > 15.0; });
    run_until(straight, 1.0, 1.0, [&] {
        DOUBLES_EQUAL(100.0, straight.feed_mm_s(), 1e-9);
        return straight.path_mm() > 45.0;
    });
    Cnc back(settings, PathBuilder(100.0).line(20.0, 0.0).line(-20.0, 0.0).moves());
    bool stood_at_the_turn = false;
    run_until(back, 1.0, 10.0, [&] {
        stood_at_the_turn = stood_at_the_turn || (back.line() == 2 && back.feed_mm_s() == 0.0 &&
                                                  back.position_mm() == Eigen::Vector3d(20.0, 0.0, 0.0));
        return back.finished();
    });
    CHECK(stood_at_the_turn);
}

TEST(CncMotion, a_tangent_arc_is_entered_without_slowing_down) {
    Cnc cnc(settings, PathBuilder(40.0).line(20.0, 0.0).arc(0.0, 10.0, pi).line(-20.0, 0.0).moves());
    run_until(cnc, 1.0, 1.0, [&] { return cnc.path_mm() > 10.0; });
    run_until(cnc, 1.0, 5.0, [&] {
        DOUBLES_EQUAL(40.0, cnc.feed_mm_s(), 1e-9);
        return cnc.path_mm() > 60.0;
    });
}

TEST(CncMotion, arcs_keep_the_centripetal_acceleration) {
    for (const double radius : {0.2, 1.0, 5.0, 20.0}) {
        Cnc cnc(settings, PathBuilder(240.0).line(30.0, 0.0).arc(0.0, radius, 2.0 * pi).line(30.0, 0.0).moves());
        const double most = std::min(240.0, std::sqrt(settings.acceleration_mm_s2 * radius));
        double fastest = 0.0;
        run_until(cnc, 1.0, 60.0, [&] {
            if (cnc.line() == 2) {
                fastest = std::max(fastest, cnc.feed_mm_s());
            }
            return cnc.finished();
        });
        CHECK(fastest <= most + 1e-9);
        CHECK(fastest > 0.99 * most);
    }
}

TEST(CncMotion, a_circle_of_a_thousand_chords_is_as_fast_as_the_arc_and_no_faster) {
    constexpr int chords = 3142;  // of 0.01 mm
    const double radius = 5.0;
    PathBuilder path(240.0);
    for (int k = 0; k < chords; ++k) {
        const double from = 2.0 * pi * k / chords;
        const double to = 2.0 * pi * (k + 1) / chords;
        path.line(radius * (std::cos(to) - std::cos(from)), radius * (std::sin(to) - std::sin(from)));
    }
    Cnc cnc(settings, path.moves());
    double fastest = 0.0;
    run_until(cnc, 1.0, 60.0, [&] {
        fastest = std::max(fastest, cnc.feed_mm_s());
        return cnc.finished();
    });
    const double centripetal = std::sqrt(settings.acceleration_mm_s2 * radius);
    CHECK(fastest > 0.98 * centripetal);
    CHECK(fastest < 1.001 * centripetal);
}

TEST(CncMotion, many_tiny_straight_segments_run_at_the_programmed_feed) {
    for (const double feed : {0.05, 0.4, 5.0, 100.0, 249.0}) {
        PathBuilder path(feed);
        for (int k = 0; k < 6000; ++k) {
            path.line(0.006, 0.008);  // 0.01 mm
        }
        Cnc cnc(settings, path.moves());
        run_until(cnc, 1.0, 10.0, [&] { return cnc.feed_mm_s() >= feed || cnc.finished(); });
        const double from = cnc.path_mm();
        CHECK(from < 30.0);
        for (int k = 0; k < 300; ++k) {
            cnc.step(1.0, false);
            DOUBLES_EQUAL(feed, cnc.feed_mm_s(), 1e-9);
        }
        DOUBLES_EQUAL(from + 300.0 * feed * settings.servo_period_s, cnc.path_mm(), 1e-6);
    }
}

TEST(CncMotion, a_slower_block_is_entered_at_its_feed_and_not_a_micrometre_too_late) {
    for (const double slow : {0.03, 0.3, 3.0, 30.0}) {
        Cnc cnc(settings, PathBuilder(100.0).line(17.3, 0.0).feed(slow).line(0.5, 0.0).moves());
        double entered_at = infinite;
        double before = 0.0;
        run_until(cnc, 1.0, 60.0, [&] {
            if (cnc.line() == 2) {
                entered_at = std::min(entered_at, before);
                CHECK(cnc.feed_mm_s() <= slow + 1e-9);
            }
            before = cnc.feed_mm_s();
            return cnc.finished();
        });
        CHECK(before <= slow + 1e-9);
    }
}

TEST(CncMotion, a_rapid_slows_down_to_the_feed_before_the_feed_move) {
    Cnc cnc(settings, PathBuilder(5.0).rapid(60.0, 0.0).line(5.0, 0.0).moves());
    double fastest_rapid = 0.0;
    run_until(cnc, 1.0, 60.0, [&] {
        if (cnc.is_rapid()) {
            fastest_rapid = std::max(fastest_rapid, cnc.feed_mm_s());
        } else {
            CHECK(cnc.feed_mm_s() <= 5.0 + 1e-9);
        }
        return cnc.finished();
    });
    DOUBLES_EQUAL(settings.rapid_feed_mm_s, fastest_rapid, 1e-9);
}

TEST(CncMotion, an_override_above_one_speeds_up_feeds_but_never_rapids_nor_the_machine) {
    Cnc rapid(settings, PathBuilder().rapid(200.0, 0.0).moves());
    double fastest = 0.0;
    run_until(rapid, 2.0, 10.0, [&] {
        fastest = std::max(fastest, rapid.feed_mm_s());
        return rapid.finished();
    });
    DOUBLES_EQUAL(settings.rapid_feed_mm_s, fastest, 1e-9);
    Cnc feed(settings, PathBuilder(100.0).line(300.0, 0.0).moves());
    fastest = 0.0;
    run_until(feed, 1e6, 10.0, [&] {
        fastest = std::max(fastest, feed.feed_mm_s());
        return feed.finished();
    });
    DOUBLES_EQUAL(settings.rapid_feed_mm_s, fastest, 1e-9);
}

TEST(CncMotion, hold_zero_negative_and_not_finite_overrides_stop_the_tool_and_release_goes_on) {
    const std::vector<std::pair<double, bool>> stopping{{1.0, true},           {0.0, false},      {-0.5, false},
                                                        {not_a_number, false}, {infinite, false}, {-infinite, false}};
    for (const auto& [ratio, hold] : stopping) {
        Cnc cnc(settings, PathBuilder(50.0).line(50.0, 0.0).moves());
        run_until(cnc, 1.0, 0.2, [] { return false; });
        const double from = cnc.path_mm();
        for (int k = 0; k < 400; ++k) {
            cnc.step(ratio, hold);
        }
        DOUBLES_EQUAL(0.0, cnc.feed_mm_s(), 0.0);
        const double standstill = cnc.path_mm();
        const double braking = 50.0 * 50.0 / (2.0 * settings.acceleration_mm_s2);
        DOUBLES_EQUAL(from + 50.0 * settings.override_latency_s + braking, standstill, 50.0 * settings.servo_period_s);
        for (int k = 0; k < 400; ++k) {
            cnc.step(ratio, hold);
        }
        DOUBLES_EQUAL(standstill, cnc.path_mm(), 0.0);
        run_to_end(cnc);
    }
}

TEST(CncMotion, a_tiny_override_creeps_and_does_not_jump) {
    Cnc cnc(settings, PathBuilder(10.0).line(1.0, 0.0).moves());
    run_until(cnc, 1e-6, 10.0, [&] {
        CHECK(cnc.feed_mm_s() <= 1e-5 + 1e-15);
        return false;
    });
    DOUBLES_EQUAL(1e-5 * (10.0 - settings.override_latency_s), cnc.path_mm(), 1e-8);
}

TEST(CncMotion, dwells_wait_as_long_as_they_say_even_one_after_another) {
    Cnc without(settings, PathBuilder(20.0).line(1.0, 0.0).line(-1.0, 0.0).moves());
    Cnc with(settings, PathBuilder(20.0).line(1.0, 0.0).dwell(0.25).dwell(0.5).line(-1.0, 0.0).dwell(0.125).moves());
    DOUBLES_EQUAL(0.875, run_to_end(with) - run_to_end(without), 4.0 * settings.servo_period_s);
}

TEST(CncMotion, a_change_of_the_spindle_speed_waits_at_rest_with_the_new_speed_commanded) {
    const auto program = [](double first, double second) {
        return PathBuilder(20.0).spindle(first).line(5.0, 0.0).spindle(second).line(5.0, 0.0).moves();
    };
    Cnc same(settings, program(400.0, 400.0));
    Cnc other(settings, program(400.0, 500.0));
    double waited_s = 0.0;
    const double time_s = run_until(other, 1.0, 10.0, [&] {
        if (other.waiting()) {
            waited_s += settings.servo_period_s;
            DOUBLES_EQUAL(0.0, other.feed_mm_s(), 0.0);
            DOUBLES_EQUAL(500.0, other.spindle_speed_rad_s(), 0.0);
            CHECK(other.position_mm() == Eigen::Vector3d(5.0, 0.0, 0.0));
        }
        return other.finished();
    });
    DOUBLES_EQUAL(settings.spindle_wait_s, waited_s, 2.0 * settings.servo_period_s);
    const double stop_and_go_s = 20.0 / settings.acceleration_mm_s2;
    DOUBLES_EQUAL(settings.spindle_wait_s + stop_and_go_s, time_s - run_to_end(same), 10.0 * settings.servo_period_s);
}

TEST(CncMotion, the_spindle_is_waited_for_after_a_dwell_as_well) {
    Cnc cnc(settings, PathBuilder(20.0).spindle(400.0).line(5.0, 0.0).dwell(0.1).spindle(500.0).line(5.0, 0.0).moves());
    double waited_s = 0.0;
    run_until(cnc, 1.0, 10.0, [&] {
        waited_s += cnc.waiting() ? settings.servo_period_s : 0.0;
        return cnc.finished();
    });
    DOUBLES_EQUAL(0.1 + settings.spindle_wait_s, waited_s, 4.0 * settings.servo_period_s);
}

TEST(CncMotion, programs_and_settings_that_no_machine_can_run_are_refused) {
    STRCMP_CONTAINS("no moves", refusal_of(settings, {}).c_str());
    auto moves = PathBuilder(20.0).line(1.0, 0.0).line(1.0, 0.0).moves();
    moves[1].feed_mm_s = 0.0;
    STRCMP_EQUAL("part program:2: found a feed of 0 mm/s, expected one above 0", refusal_of(settings, moves).c_str());
    moves[1].feed_mm_s = 20.0;
    moves[1].end_mm.y() = not_a_number;
    STRCMP_CONTAINS("part program:2: found a position", refusal_of(settings, moves).c_str());
    moves = PathBuilder(20.0).dwell(-1.0).moves();
    STRCMP_CONTAINS("part program:1: found a dwell of -1 s", refusal_of(settings, moves).c_str());
    CncSettings bad;
    bad.acceleration_mm_s2 = 0.0;
    STRCMP_EQUAL("cnc.acceleration_mm_s2: 0, expected 1 to 1000000",
                 refusal_of(bad, PathBuilder().line(1.0, 0.0).moves()).c_str());
    bad = {};
    bad.override_latency_s = not_a_number;
    STRCMP_CONTAINS("cnc.override_latency_s: nan", refusal_of(bad, PathBuilder().line(1.0, 0.0).moves()).c_str());
}
