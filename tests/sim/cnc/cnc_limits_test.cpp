// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "cnc/cnc.hpp"
#include "programs.hpp"

// Behind Eigen: it replaces operator new by a macro.
#include <CppUTest/TestHarness.h>

using namespace millforce::sim;

namespace {

constexpr double rounding = 1e-7;

/// An override that jumps, ramps, holds and fails, as no sane controller would.
class WildOverride {
  public:
    explicit WildOverride(RandomNumbers& random) : random_(random) {}

    double next() {
        if (left_-- == 0) {
            left_ = random_.whole(1, 400);
            const std::size_t kind = random_.whole(0, 9);
            ratio_ = kind == 0 ? 0.0 : kind == 1 ? std::nan("") : kind == 2 ? -1.0 : random_.between(0.01, 2.0);
        }
        return ratio_;
    }

  private:
    RandomNumbers& random_;
    std::size_t left_ = 0;
    double ratio_ = 1.0;
};

/// Watches a run from outside and checks every promise of the header after each period.
class Watcher {
  public:
    Watcher(const CncSettings& settings, const std::vector<Move>& moves)
        : settings_(settings), moves_(moves), cnc_(settings, moves) {
        const auto periods = std::lround(settings.override_latency_s / settings.servo_period_s);
        delay_.assign(static_cast<std::size_t>(periods), 0.0);
        step_ = settings.acceleration_mm_s2 * settings.servo_period_s;
    }

    bool finished() const { return cnc_.finished(); }

    void step(double ratio) {
        delay_.push_back(std::isfinite(ratio) && ratio > 0.0 ? ratio : 0.0);
        acting_ =
            delay_[delay_.size() - 1 -
                   static_cast<std::size_t>(std::lround(settings_.override_latency_s / settings_.servo_period_s))];
        const std::size_t from = cnc_.line();
        cnc_.step(ratio, false);
        check_acceleration();
        check_limits(from, cnc_.finished() ? moves_.size() : cnc_.line());
        before_mm_s_ = cnc_.feed_mm_s();
        before_path_mm_ = cnc_.path_mm();
    }

  private:
    void check_acceleration() {
        CHECK(std::abs(cnc_.feed_mm_s() - before_mm_s_) <= step_ + rounding);
        const double along_mm_s = (cnc_.path_mm() - before_path_mm_) / settings_.servo_period_s;
        CHECK(along_mm_s >= -rounding);
        const double tolerance_mm_s = 1.1e-9 / settings_.servo_period_s;  // the last nanometre to a stop
        CHECK(std::abs(along_mm_s - along_before_mm_s_) <= step_ + tolerance_mm_s);
        along_before_mm_s_ = along_mm_s;
    }

    /// Every block that this period touched, and every corner that it passed.
    void check_limits(std::size_t from_line, std::size_t to_line) {
        const double v = along_before_mm_s_;
        const double tolerance = 1e-5;
        const bool full_braking = v <= before_mm_s_ - step_ + tolerance;
        for (std::size_t line = from_line; line <= to_line; ++line) {
            const Move& move = moves_[line - 1];
            if (move.kind == MoveKind::dwell || (line == to_line && line != from_line && cnc_.feed_mm_s() == 0.0)) {
                continue;
            }
            const double programmed = move.kind == MoveKind::rapid
                                          ? settings_.rapid_feed_mm_s * std::min(1.0, acting_)
                                          : std::min(settings_.rapid_feed_mm_s, move.feed_mm_s * acting_);
            CHECK(full_braking || v <= programmed + tolerance);
            CHECK(!is_arc(move) || v <= std::sqrt(settings_.acceleration_mm_s2 * arc_radius_mm(move)) + tolerance);
            if (line < to_line) {
                check_corner(move, moves_[line], v, tolerance);
            }
        }
    }

    void check_corner(const Move& move, const Move& next, double v, double tolerance) const {
        if (next.kind == MoveKind::dwell || next.spindle_speed_rad_s != move.spindle_speed_rad_s) {
            CHECK(v <= step_ + tolerance);  // its last period ends at rest
            return;
        }
        const double cosine = direction_at(move, length_mm(move)).dot(direction_at(next, 0.0));
        const double deflection = std::acos(std::clamp(cosine, -1.0, 1.0));
        if (deflection > std::numbers::pi - 1e-6) {
            CHECK(v <= step_ + tolerance);
        } else if (deflection > 1e-3) {
            CHECK(v <= corner_speed_mm_s(deflection, settings_) * (1.0 + 1e-6) + tolerance);
        }
    }

    CncSettings settings_;
    std::vector<Move> moves_;
    Cnc cnc_;
    std::vector<double> delay_;
    double acting_ = 0.0;
    double step_ = 0.0;
    double before_mm_s_ = 0.0;
    double before_path_mm_ = 0.0;
    double along_before_mm_s_ = 0.0;
};

CncSettings random_settings(RandomNumbers& random) {
    CncSettings settings;
    settings.servo_period_s = random.whole(0, 1) == 0 ? 0.25e-3 : 1e-3;
    settings.acceleration_mm_s2 = random.between(300.0, 6000.0);
    settings.override_latency_s = random.between(0.0, 0.03);
    settings.spindle_wait_s = 0.05;
    return settings;
}

}  // namespace

TEST_GROUP(CncLimits){};

TEST(CncLimits, no_random_override_on_no_random_program_breaks_acceleration_feed_arc_or_corner) {
    RandomNumbers random(20260719);
    for (int k = 0; k < 300; ++k) {
        const CncSettings settings = random_settings(random);
        Watcher watcher(settings, random_program(random));
        WildOverride wild(random);
        for (int n = 0; n < 20000 && !watcher.finished(); ++n) {
            watcher.step(wild.next());
        }
    }
}

TEST(CncLimits, with_a_steady_override_no_block_is_ever_entered_too_fast) {
    RandomNumbers random(7);
    for (int k = 0; k < 300; ++k) {
        const CncSettings settings = random_settings(random);
        const auto moves = random_program(random);
        const double ratio = random.between(0.05, 2.0);
        Cnc cnc(settings, moves);
        double path_before = 0.0;
        while (!cnc.finished()) {
            const std::size_t from = cnc.line();
            cnc.step(ratio, false);
            const double v = (cnc.path_mm() - path_before) / settings.servo_period_s;
            path_before = cnc.path_mm();
            for (std::size_t line = from; line <= cnc.line() && cnc.feed_mm_s() > 0.0; ++line) {
                const Move& move = moves[line - 1];
                const double allowed = move.kind == MoveKind::rapid ? settings.rapid_feed_mm_s * std::min(1.0, ratio)
                                                                    : move.feed_mm_s * ratio;
                CHECK(move.kind == MoveKind::dwell || v <= allowed + 1e-5);
            }
        }
    }
}

TEST(CncLimits, every_program_ends_where_it_should) {
    RandomNumbers random(99);
    for (int k = 0; k < 300; ++k) {
        const CncSettings settings = random_settings(random);
        const auto moves = random_program(random);
        double length = 0.0;
        double slowest = settings.rapid_feed_mm_s;
        double waits_s = 0.0;
        for (const Move& move : moves) {
            length += length_mm(move);
            slowest = move.feed_mm_s > 0.0 ? std::min(slowest, move.feed_mm_s) : slowest;
            waits_s += move.dwell_s + settings.spindle_wait_s;
        }
        const double ratio = random.between(0.05, 2.0);
        const double ramps_s =
            static_cast<double>(moves.size()) * (2.0 * slowest * ratio / settings.acceleration_mm_s2 + 0.1);
        const double longest_s = length / (slowest * std::min(1.0, ratio)) + ramps_s + waits_s + 1.0;
        Cnc cnc(settings, moves);
        double time_s = 0.0;
        for (; !cnc.finished() && time_s < longest_s; time_s += settings.servo_period_s) {
            cnc.step(ratio, false);
        }
        CHECK(cnc.finished());
        CHECK(cnc.position_mm() == moves.back().end_mm);
    }
}

TEST(CncLimits, an_override_that_falls_on_the_way_into_a_slower_block_brakes_fully_and_nothing_more) {
    CncSettings settings;
    settings.override_latency_s = 0.0;
    Cnc cnc(settings, PathBuilder(100.0).line(30.0, 0.0).feed(80.0).line(30.0, 0.0).moves());
    while (cnc.path_mm() < 29.5) {
        cnc.step(1.0, false);
    }
    double expected = cnc.feed_mm_s();
    const double step = settings.acceleration_mm_s2 * settings.servo_period_s;
    for (int k = 0; k < 300; ++k) {
        cnc.step(0.1, false);
        expected = std::max(cnc.line() == 1 ? 10.0 : 8.0, expected - step);
        CHECK(cnc.feed_mm_s() <= expected + 1e-9);
    }
    DOUBLES_EQUAL(8.0, cnc.feed_mm_s(), 1e-9);
}

TEST(CncLimits, three_hundred_thousand_tiny_segments_with_changing_feeds_cost_little_time_each) {
    PathBuilder path(100.0);
    for (int k = 0; k < 300000; ++k) {
        path.feed(k % 2 == 0 ? 100.0 : 90.0).line(0.001, 0.0);
    }
    Cnc cnc(CncSettings{}, path.moves());
    long steps = 0;
    const auto begin = std::chrono::steady_clock::now();
    while (!cnc.finished() && steps < 1000000) {
        cnc.step(1.0, false);
        ++steps;
    }
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    CHECK(cnc.finished());
    // 300 mm; 256 changes ahead are 0.256 mm, enough to stop from √(2 · 2000 · 0.256) = 32 mm/s.
    CHECK(static_cast<double>(steps) * 0.25e-3 < 300.0 / 30.0);
    CHECK(wall.count() < 5.0);  // a quadratic look-ahead would take minutes
}
