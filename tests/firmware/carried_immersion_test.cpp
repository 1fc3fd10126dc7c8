// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "estimation/number/fixed_point.hpp"
#include "firmware/carried_immersion_impl.hpp"

#include <CppUTest/TestHarness.h>

using Carried = millforce::firmware::CarriedImmersion<float>;
using millforce::estimation::Measurement;

namespace {

constexpr Measurement<float> unknown{};

Measurement<float> immersion(float value) {
    return {true, value, 0.0F};
}

/// The drops of a cut whose section is 10 mm² say 0.5; then those of another section say another immersion.
Carried after_a_growth_to(float section_mm2, float then) {
    Carried carried;
    carried.follow_section(10.0F);
    carried.take(immersion(0.5F), unknown);
    carried.follow_section(section_mm2);
    carried.take(immersion(then), immersion(0.5F));
    return carried;
}

double carried_by_a_tenth(const Carried& carried, float from, float section_mm2) {
    return static_cast<double>(carried.carry(immersion(from), 1.1F * section_mm2).value / from);
}

}  // namespace

TEST_GROUP(CarriedImmersion){};

TEST(CarriedImmersion, says_nothing_before_the_first_drops_nor_of_a_section_that_is_not_known) {
    Carried carried;
    CHECK_FALSE(carried.carry(immersion(0.5F), 10.0F).valid);
    carried.take(immersion(0.5F), unknown);  // without a section
    CHECK_FALSE(carried.carry(immersion(0.5F), 10.0F).valid);
    carried.follow_section(10.0F);
    carried.take(immersion(0.5F), unknown);
    CHECK_TRUE(carried.carry(immersion(0.5F), 10.0F).valid);
    CHECK_FALSE(carried.carry(immersion(0.5F), 0.0F).valid);
    CHECK_FALSE(carried.carry(unknown, 10.0F).valid);
}

TEST(CarriedImmersion, takes_half_of_the_growth_for_width_where_nothing_is_known_of_it) {
    Carried carried;
    carried.follow_section(8.0F);
    carried.follow_section(12.0F);  // 10 on average
    carried.take(immersion(0.5F), unknown);
    const Measurement<float> now = carried.carry(immersion(0.5F), 12.0F);
    DOUBLES_EQUAL(0.55, static_cast<double>(now.value), 1e-6);
    DOUBLES_EQUAL(0.5 * 0.2 / std::sqrt(12.0), std::sqrt(static_cast<double>(now.variance)), 1e-6);
}

TEST(CarriedImmersion, splits_the_growth_as_it_was_split_before_by_half) {
    DOUBLES_EQUAL(1.0 + 0.1 * 0.75, carried_by_a_tenth(after_a_growth_to(12.0F, 0.6F), 0.6F, 12.0F), 1e-5);
    DOUBLES_EQUAL(1.0 + 0.1 * 0.25, carried_by_a_tenth(after_a_growth_to(12.0F, 0.5F), 0.5F, 12.0F), 1e-5);
    DOUBLES_EQUAL(1.0 + 0.1 * 0.75, carried_by_a_tenth(after_a_growth_to(12.0F, 0.9F), 0.9F, 12.0F), 1e-5);
    DOUBLES_EQUAL(1.0 + 0.1 * 0.5, carried_by_a_tenth(after_a_growth_to(10.3F, 0.6F), 0.6F, 10.3F), 1e-5);
}

TEST(CarriedImmersion, forgets_the_split_where_drops_were_not_valid) {
    Carried carried = after_a_growth_to(12.0F, 0.6F);
    carried.follow_section(12.0F);
    carried.take(unknown, immersion(0.6F));
    DOUBLES_EQUAL(1.0 + 0.1 * 0.5, carried_by_a_tenth(carried, 0.6F, 12.0F), 1e-5);
    carried = after_a_growth_to(12.0F, 0.6F);
    carried.follow_section(14.4F);
    carried.take(immersion(0.72F), {false, 0.6F, 0.0F});
    DOUBLES_EQUAL(1.0 + 0.1 * 0.5, carried_by_a_tenth(carried, 0.72F, 14.4F), 1e-5);
}

TEST(CarriedImmersion, is_of_no_use_after_a_growth_by_half) {
    Carried carried;
    carried.follow_section(10.0F);
    carried.take(immersion(0.5F), unknown);
    CHECK_TRUE(carried.carry(immersion(0.5F), 14.9F).valid);
    CHECK_FALSE(carried.carry(immersion(0.5F), 15.1F).valid);
    CHECK_FALSE(carried.carry(immersion(0.5F), 4.9F).valid);
}

TEST(CarriedImmersion, learns_no_split_from_a_section_or_an_immersion_of_nothing) {
    Carried from_no_section;
    from_no_section.take(immersion(0.5F), unknown);
    from_no_section.follow_section(10.0F);
    from_no_section.take(immersion(0.6F), immersion(0.5F));
    DOUBLES_EQUAL(1.0 + 0.1 * 0.5, carried_by_a_tenth(from_no_section, 0.6F, 10.0F), 1e-5);

    Carried from_no_immersion;
    from_no_immersion.follow_section(10.0F);
    from_no_immersion.take(immersion(0.0F), unknown);
    from_no_immersion.follow_section(12.0F);
    from_no_immersion.take(immersion(0.6F), immersion(0.0F));
    DOUBLES_EQUAL(1.0 + 0.1 * 0.5, carried_by_a_tenth(from_no_immersion, 0.6F, 12.0F), 1e-5);
}

TEST(CarriedImmersion, divides_by_no_section_of_nothing) {
    using millforce::estimation::Fixed;
    const Measurement<Fixed> half{true, Fixed(0.5F), Fixed(0)};
    millforce::firmware::CarriedImmersion<Fixed> carried;
    const std::uint32_t before = millforce::estimation::saturations();
    carried.take(half, {});
    CHECK_FALSE(carried.carry(half, Fixed(10)).valid);
    UNSIGNED_LONGS_EQUAL(before, millforce::estimation::saturations());
}
