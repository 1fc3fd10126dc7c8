// SPDX-License-Identifier: Apache-2.0
#include "part_map/map_learner.hpp"
#include "firmware/tick_bench.hpp"
#include "wrong_maps/wrong_maps.hpp"

#include <CppUTest/TestHarness.h>

#include <limits>

using namespace millforce;
using namespace millforce::test;
using namespace millforce::host;

namespace {

constexpr float step_s = 0.001F;

/// With that share of the sample's cutting forces.
hal::DriveSample with_load(hal::DriveSample sample, float share) {
    const Parameters p = machine_and_tool();
    const float idle_A = -p.machine.spindle.K_t2_Nm / p.machine.spindle.K_t1_Nm_per_A;
    const auto& x = p.machine.axes[0];
    const float friction_A = x.positive.at(feed_mm_s * 0.06F) + x.K_x3_A;
    sample.spindle_current_A = idle_A + share * (sample.spindle_current_A - idle_A);
    sample.axis_current_A[0] = friction_A + share * (sample.axis_current_A[0] - friction_A);
    return sample;
}

/// A machine that goes along its program's blocks at 20 mm/s: 4 mm of air, and then in the cut of sample_of().
class Machine {
  public:
    explicit Machine(MapLearner& learner) : learner_(learner) {}

    void block(std::uint32_t line, float length_mm, float left_mm = 0.0F) {
        const int steps = static_cast<int>((length_mm - left_mm) / (feed_mm_s * step_s));
        for (int k = 0; k <= steps; ++k) {
            report(line, length_mm - feed_mm_s * step_s * static_cast<float>(k));
        }
    }
    /// The cut's forces, as a share of those of sample_of().
    void set_load(float share) { load_ = share; }
    void report(std::uint32_t line, float to_go_mm) {
        hal::ProgramStatus status = program();
        status.line = line;
        status.distance_to_go_mm = to_go_mm;
        tick_.take(with_load(sample_of(samples_++), load_));
        firmware::finish_estimate(tick_);
        learner_.take(tick_, status);
        tick_.answer(status);
    }

  private:
    MapLearner& learner_;
    firmware::ForceControlTick<float> tick_ = fresh_tick();
    int samples_ = 0;
    float load_ = 1.0F;
};

double length_mm(const PartMap& map) {
    return map.empty() ? 0.0 : map.back().path_mm;
}

}  // namespace

TEST_GROUP(MapLearner) {
    MapLearner learner{machine_and_tool()};
    Machine machine{learner};
};

TEST(MapLearner, learns_air_and_the_cut_behind_it_along_a_block) {
    machine.block(3, 60.0F);
    const PartMap map = learner.map();
    DOUBLES_EQUAL(60.0, length_mm(map), 0.1);
    LONGS_EQUAL(3, map.front().line);
    CHECK(place_holding_at(map, 2.0).known == Known::cut);
    CHECK(place_holding_at(map, 2.0).cut.empty());
    CHECK(place_holding_at(map, 5.0).known == Known::at_most);  // the cutter enters
    CHECK(place_holding_at(map, 40.0).known == Known::cut);
    LONGS_EQUAL(1, place_holding_at(map, 40.0).cut.size());
    DOUBLES_EQUAL(20.0, map.front().programmed_feed_mm_s, 1e-6);
    CHECK(map.back().cut.empty());
    CHECK(map.back().known == Known::cut);
}

/// The tool's contact is at 4 mm.
TEST(MapLearner, of_air_beside_a_cut_says_that_another_blank_may_have_stock_there) {
    machine.block(3, 60.0F);
    CHECK(place_holding_at(learner.map(), 2.5).known == Known::cut);
    CHECK(place_holding_at(learner.map(), 3.5).known == Known::at_most);
    DOUBLES_EQUAL(0.0, place_holding_at(learner.map(), 3.5).least_share, 0.0);
    learner.set_stock_tolerance(1.0);
    CHECK(place_holding_at(learner.map(), 1.5).known == Known::cut);
    CHECK(place_holding_at(learner.map(), 2.5).known == Known::at_most);
    learner.set_stock_tolerance(0.0);
    CHECK(place_holding_at(learner.map(), 3.5).known == Known::cut);
    CHECK(place_holding_at(learner.map(), 3.5).cut.empty());
}

/// What the noise may hide at this feed, a tooth of a weak tool could not bear at that of air.
TEST(MapLearner, does_not_know_air_in_which_a_cut_may_be_hidden) {
    Parameters weak = machine_and_tool();
    weak.tool.tooth_force_limit_N = 30.0F;
    MapLearner of_weak_tool(weak);
    Machine with_weak_tool(of_weak_tool);
    with_weak_tool.block(3, 60.0F);
    CHECK(place_holding_at(of_weak_tool.map(), 2.0).known == Known::nothing);
    CHECK(place_holding_at(of_weak_tool.map(), 40.0).known == Known::cut);
}

/// As over a hole, whose forces are those of a shallow cut.
TEST(MapLearner, takes_a_cut_that_seems_much_shallower_beside_a_deep_one_for_at_most_that_one) {
    machine.block(3, 60.0F);
    machine.set_load(2.0F);
    machine.block(3, 60.0F);
    const PartMap map = learner.map();
    const MapPlace& shallow = place_holding_at(map, 30.0);
    const MapPlace& beside = place_holding_at(map, 50.0);
    const double deep_mm = place_holding_at(map, 100.0).cut.front().axial_depth_mm;
    CHECK(shallow.known == Known::cut);
    CHECK(shallow.cut.front().axial_depth_mm < 0.6 * deep_mm);
    CHECK(beside.known == Known::at_most);
    DOUBLES_EQUAL(deep_mm, beside.cut.front().axial_depth_mm, 0.1 * deep_mm);
}

TEST(MapLearner, learns_nothing_without_a_line_or_a_way_to_go) {
    for (int k = 0; k < 100; ++k) {
        machine.report(0, 30.0F);
        machine.report(3, std::numeric_limits<float>::quiet_NaN());
        machine.report(3, -1.0F);
    }
    CHECK(learner.map().empty());
    STRCMP_EQUAL("nothing learnt", about_memory(learner.map()).c_str());
}

TEST(MapLearner, joins_blocks_to_one_path_and_keeps_their_ends) {
    machine.block(3, 20.0F);
    machine.block(4, 10.0F);
    const PartMap map = learner.map();
    DOUBLES_EQUAL(30.0, length_mm(map), 0.1);
    DOUBLES_EQUAL(20.0, map.front().block_end_mm, 0.1);
    DOUBLES_EQUAL(30.0, map.back().block_end_mm, 0.1);
    LONGS_EQUAL(4, map.back().line);
}

/// The CNC goes on with the next block before it has told the end of this one, or tells a longer way in a corner.
TEST(MapLearner, takes_a_blended_corner_for_the_same_block_and_a_longer_way_for_the_next_one) {
    machine.block(3, 20.0F, 10.0F);
    machine.report(3, 10.3F);
    machine.block(3, 10.0F);
    DOUBLES_EQUAL(20.0, learner.map().back().block_end_mm, 0.1);
    machine.block(3, 15.0F);  // the same line once more, as in a loop
    DOUBLES_EQUAL(35.0, learner.map().back().block_end_mm, 0.2);
}

TEST(MapLearner, of_a_program_that_begins_again_keeps_the_longer_of_its_last_two_runs) {
    machine.block(3, 20.0F);
    machine.block(4, 30.0F);
    machine.block(3, 20.0F);
    machine.block(4, 30.0F, 25.0F);  // aborted
    DOUBLES_EQUAL(50.0, length_mm(learner.map()), 0.2);
    machine.block(3, 20.0F);
    machine.block(4, 30.0F);
    machine.block(5, 10.0F);
    DOUBLES_EQUAL(60.0, length_mm(learner.map()), 0.2);
}

TEST(MapLearner, does_not_know_a_way_that_was_not_reported) {
    machine.block(3, 100.0F, 60.0F);
    machine.block(3, 40.0F);  // 20 mm later
    const PartMap map = learner.map();
    CHECK(place_holding_at(map, 50.0).known == Known::nothing);
    CHECK(place_holding_at(map, 80.0).known == Known::cut);
    STRCMP_CONTAINS("100 mm of path learnt, ", about_memory(map).c_str());
    STRCMP_CONTAINS(" mm of it not known", about_memory(map).c_str());
}

TEST_GROUP(MapLearnerOfTools) {
    const Parameters parameters = machine_and_tool();
    MapLearner learner{parameters.machine, {{1, parameters.tool}, {7, parameters.tool}}};
    Machine machine{learner};
};

TEST(MapLearnerOfTools, learns_for_each_tool_the_path_that_it_goes_itself) {
    machine.block(2, 10.0F);  // before a tool was named
    learner.set_tool(1);
    machine.block(3, 20.0F);
    learner.set_tool(7);
    machine.block(4, 30.0F);
    learner.set_tool(5);  // without a file
    machine.block(5, 40.0F);
    learner.set_tool(1);
    machine.block(6, 15.0F);
    DOUBLES_EQUAL(35.0, length_mm(learner.map(1)), 0.2);
    DOUBLES_EQUAL(30.0, length_mm(learner.map(7)), 0.2);
    CHECK(learner.map(5).empty());
    LONGS_EQUAL(4, learner.map(7).front().line);
    LONGS_EQUAL(6, learner.map(1).back().line);
}
