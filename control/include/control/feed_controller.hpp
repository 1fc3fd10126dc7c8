// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/cut_state.hpp"
#include "control/cut_trend.hpp"
#include "control/feed_controller_data.hpp"
#include "control/path_turn.hpp"
#include "estimation/cutting/cut_geometry.hpp"
#include "estimation/number/elementary.hpp"

/// The feed override that holds the largest force on a tooth at its limit.
///
/// Force grows with feed as F = F₀ [(1 − c) + c (f/f₀)^(1+p_s)], c the share of F that is not edge force, and its gain
/// varies by an order of magnitude along a part (depth, immersion). A loop with a fixed gain is slow or unstable there.
/// So the law inverts the process at the measured point (f, F),
///
///   f* = f {[F_set/F − (1 − c)]/c}^(1/(1+p_s)),
///
/// with f and F averaged over the same window of tooth periods: the depth, the immersion and K_s cancel, and a delay
/// between override and force delays the correction but does not add to it. Where the edge force alone exceeds the set
/// point no feed helps, and f* is 0. f* below the present feed is taken at
/// once; f* above it is approached by a share per revolution. Ceilings follow, and the smallest wins.
///
/// No estimate, no rise: without an estimate the override may fall (the tangential force alone suffices for that) or
/// stay, never grow. Output is finite and within [override_min, override_max] whatever the input. Not thread-safe.

namespace millforce::control {

template <typename Scalar>
class FeedController {
  public:
    [[gnu::cold, gnu::noinline]] explicit FeedController(const FeedControllerParameters<Scalar>& parameters = {})
        : parameters_(parameters),
          recovery_per_rad_(parameters.recovery_per_rev * estimation::turns_per_rad<Scalar>),
          ratio_(parameters.override_min),
          highest_feed_mm_s_(parameters.highest_programmed_feed_mm_s) {
        if (!configuration_is_sound()) {
            fault_ = Fault::bad_configuration;
            state_ = CutState::fault;
            parameters_.override_min = Scalar(0);
            parameters_.override_max = Scalar(0);
            ratio_ = Scalar(0);
        }
    }

    [[nodiscard]] CutState state() const { return state_; }

    /// Leaves a latched fault. Only at standstill: the caller has seen the spindle stop or the operator acknowledge.
    [[gnu::cold]] void reset() {
        if (fault_ != Fault::bad_configuration) {
            *this = FeedController(parameters_);
        }
    }

    [[gnu::always_inline]] ControlOutput<Scalar> step(const ControlInput<Scalar>& input) {
        // A step of unknown, negative or absurd length moves nothing; a speed that is no number counts as rest.
        dt_s_ = input.dt_s > Scalar(0) && input.dt_s < Scalar(1) ? input.dt_s : Scalar(0);
        path_speed_mm_s_ = is_finite(input.path_speed_mm_s) ? input.path_speed_mm_s : Scalar(0);
        way_mm_ = path_speed_mm_s_ * dt_s_;
        since_estimate_s_ = input.cut.fresh ? Scalar(0) : since_estimate_s_ + dt_s_;
        update_state(input);
        watch_turns(input);
        if (basis_.has_changed(basis_of(input)) || input.cut.fresh || turned_now_) {
            wanted_ = wanted_ratio(input, limit_);
        }
        approach(wanted_, input);
        ControlOutput<Scalar> output;
        output.state = state_;
        output.fault = fault_;
        output.limit = limit_;
        output.fading = trend_.fading();
        output.rising = wanted_ > static_cast<Scalar>(1.25L) * ratio_;
        output.hold = state_ == CutState::fault || input.feed_hold;
        output.ratio = ratio_;
        if (parameters_.monitor_only && state_ != CutState::fault) {
            output.ratio = bounded(input.operator_override);
        }
        return output;
    }

  private:
    [[nodiscard, gnu::cold]] bool configuration_is_sound() const {
        const auto& p = parameters_;
        const auto positive = [](Scalar value) { return is_finite(value) && value > Scalar(0); };
        const auto not_negative = [](Scalar value) { return is_finite(value) && value >= Scalar(0); };
        return positive(p.tooth_force_limit_N) && positive(p.setpoint_share) && not_negative(p.caution_sd) &&
               not_negative(p.override_min) && is_finite(p.override_max) && p.override_max > p.override_min &&
               p.override_max < Scalar(10) && positive(p.recovery_per_rev) && positive(p.slew_up_per_s) &&
               positive(p.slew_down_per_s) && positive(p.entry_feed_per_tooth_mm) &&
               positive(p.air_feed_per_tooth_mm) && positive(p.max_feed_per_tooth_mm) &&
               not_negative(p.highest_programmed_feed_mm_s) && not_negative(p.entry_revolutions) &&
               not_negative(p.entry_travel_mm) && not_negative(p.exit_travel_mm) && positive(p.contact_force_N) &&
               not_negative(p.contact_significance) && not_negative(p.surge_radial_immersion) &&
               positive(p.surge_share) && not_negative(p.turn_radial_immersion) && not_negative(p.turn_travel_mm) &&
               positive(p.overload_share) && not_negative(p.overload_revolutions) &&
               not_negative(p.no_estimate_hold_s) && not_negative(p.Ra_limit_um) && positive(p.stale_s) &&
               is_finite(p.teeth) && p.teeth >= Scalar(1);
    }

    [[nodiscard]] static bool is_finite(Scalar value) { return value - value == Scalar(0); }

    /// NaN becomes the minimum.
    [[nodiscard]] Scalar bounded(Scalar ratio) const {
        if (!(ratio >= parameters_.override_min)) {
            return parameters_.override_min;
        }
        return ratio > parameters_.override_max ? parameters_.override_max : ratio;
    }

    [[nodiscard]] bool is_in_contact(const CutEstimateForControl<Scalar>& cut) const {
        return cut.force_valid && cut.tangential_N > parameters_.contact_force_N &&
               cut.tangential_N > parameters_.contact_significance * cut.tangential_sd_N;
    }

    [[nodiscard]] bool has_lost_contact(const CutEstimateForControl<Scalar>& cut) const {
        return cut.force_valid && cut.tangential_N < Scalar(0.5F) * parameters_.contact_force_N;
    }

    void update_state(const ControlInput<Scalar>& input) {
        if (state_ == CutState::fault) {
            return;
        }
        if (input.time_since_sample_s > parameters_.stale_s || !is_finite(input.time_since_sample_s)) {
            enter_fault(Fault::stale_input);
            return;
        }
        watch_spindle(input);
        watch_overload(input);
        if (state_ == CutState::fault) {
            return;
        }
        travel_in_state_mm_ += way_mm_;
        const bool silent = !input.cut.force_valid;
        silent_s_ = silent ? silent_s_ + dt_s_ : Scalar(0);
        if (input.cut.fresh) {
            follow_contact(input);
        }
        const bool cutting = state_ == CutState::in_cut || state_ == CutState::entry;
        if ((cutting && silent_s_ > parameters_.no_estimate_hold_s) || input.feed_hold) {
            go_to(CutState::hold);
        }
    }

    void follow_contact(const ControlInput<Scalar>& input) {
        const bool contact = is_in_contact(input.cut);
        const bool lost = has_lost_contact(input.cut);
        periods_in_state_ += input.cut.tooth_periods;
        switch (state_) {
            case CutState::air:
                if (contact) {
                    go_to(CutState::entry);
                }
                break;
            case CutState::entry:
                if (lost) {
                    go_to(CutState::exit);
                } else if (periods_in_state_ >= parameters_.entry_revolutions * parameters_.teeth &&
                           travel_in_state_mm_ >= parameters_.entry_travel_mm) {
                    go_to(CutState::in_cut);
                }
                break;
            case CutState::in_cut:
                if (lost) {
                    go_to(CutState::exit);
                }
                break;
            case CutState::exit:
                if (contact) {
                    go_to(CutState::entry);
                } else if (input.cut.force_valid && travel_in_state_mm_ > parameters_.exit_travel_mm) {
                    go_to(CutState::air);
                }
                break;
            case CutState::hold:
                if (!input.feed_hold && input.cut.force_valid) {
                    go_to(contact ? CutState::entry : CutState::exit);
                }
                break;
            case CutState::fault:
                break;
        }
    }

    void go_to(CutState state) {
        if (state == state_) {
            return;
        }
        has_cut_ = state == CutState::in_cut || (has_cut_ && state != CutState::air);
        // What was cut before the gap was survived at this feed; from air, contact starts at the entry feed.
        ratio_at_entry_ = state == CutState::entry && !has_cut_ ? Scalar(-1) : ratio_;
        state_ = state;
        travel_in_state_mm_ = Scalar(0);
        periods_in_state_ = Scalar(0);
    }

    void enter_fault(Fault fault) {
        fault_ = fault;
        state_ = CutState::fault;
    }

    void watch_spindle(const ControlInput<Scalar>& input) {
        const bool cutting = state_ == CutState::in_cut || state_ == CutState::entry;
        if (cutting && !input.cut.spindle_turning && path_speed_mm_s_ > Scalar(0)) {
            stopped_s_ += dt_s_;
            if (stopped_s_ > parameters_.stale_s) {
                enter_fault(Fault::spindle_stopped);
            }
        } else {
            stopped_s_ = Scalar(0);
        }
    }

    void watch_overload(const ControlInput<Scalar>& input) {
        if (!input.cut.fresh) {
            return;
        }
        const bool over = input.cut.force_valid && input.cut.tooth_force_valid && !input.cut.tooth_force_is_bound &&
                          input.cut.tooth_force_N > parameters_.overload_share * parameters_.tooth_force_limit_N;
        // An estimate is that of one revolution, however long ago the last one was.
        const Scalar seen = input.cut.tooth_periods < parameters_.teeth ? input.cut.tooth_periods : parameters_.teeth;
        overload_periods_ = over ? overload_periods_ + seen : Scalar(0);
        if (overload_periods_ > parameters_.overload_revolutions * parameters_.teeth && !parameters_.monitor_only) {
            enter_fault(Fault::overload);
        }
    }

    void follow_tooth_period(Scalar spindle_speed_rad_s) {
        if (spindle_speed_rad_s == basis_.spindle_speed_rad_s) {
            return;
        }
        constexpr Scalar turn_rad = static_cast<Scalar>(6.28318530717958648L);
        const Scalar teeth_rad_s = spindle_speed_rad_s * parameters_.teeth;
        tooth_period_s_ = teeth_rad_s > Scalar(0) ? turn_rad / teeth_rad_s : Scalar(0);
    }

    void watch_turns(const ControlInput<Scalar>& input) {
        way_since_estimate_mm_ += way_mm_;
        follow_tooth_period(input.cut.spindle_speed_rad_s);
        const bool turned = turn_.update({dt_s_, input.velocity_x_mm_s, input.velocity_y_mm_s, path_speed_mm_s_,
                                          way_mm_, ratio_, input.programmed_feed_mm_s, tooth_period_s_});
        const Scalar left_mm = turn_travel_left_mm_ - way_mm_;
        turn_travel_left_mm_ = turned ? parameters_.turn_travel_mm : (left_mm > Scalar(0) ? left_mm : Scalar(0));
        turned_now_ = turned;
        if (turned && state_ == CutState::exit) {
            go_to(CutState::air);  // what was cut before says nothing about what lies ahead now
        }
    }

    /// All that the wanted override depends on between two estimates. It is not worked out anew while this stays: a
    /// ceiling at the present override stays where the override was when it was set, since nothing rises beyond it.
    struct Basis {
        Scalar programmed_feed_mm_s{-1};
        Scalar operator_override{-1};
        Scalar spindle_speed_rad_s{-1};
        std::uint32_t flags = 0;

        /// Takes the new one. What is no number has always changed.
        bool has_changed(const Basis& now) {
            const bool same = flags == now.flags && programmed_feed_mm_s == now.programmed_feed_mm_s &&
                              operator_override == now.operator_override &&
                              spindle_speed_rad_s == now.spindle_speed_rad_s;
            if (!same) {
                *this = now;
            }
            return !same;
        }
    };

    [[nodiscard]] Basis basis_of(const ControlInput<Scalar>& input) const {
        const auto bit = [](bool value, unsigned place) { return static_cast<std::uint32_t>(value) << place; };
        const bool is_behind_turn = turn_travel_left_mm_ > Scalar(0);
        const std::uint32_t flags = static_cast<std::uint32_t>(state_) | bit(input.rapid, 8) | bit(input.plunging, 9) |
                                    bit(input.cut.force_valid, 10) | bit(input.cut.tooth_force_valid, 11) |
                                    bit(input.surface.valid, 12) | bit(input.surface.in_range, 13) |
                                    bit(is_behind_turn, 14) | bit(true, 15);
        return {input.programmed_feed_mm_s, input.operator_override, input.cut.spindle_speed_rad_s, flags};
    }

    [[nodiscard]] Scalar ratio_of_feed_per_tooth(Scalar feed_per_tooth_mm, const ControlInput<Scalar>& input) const {
        const Scalar feed_mm_s =
            feed_per_tooth_mm * parameters_.teeth * input.cut.spindle_speed_rad_s * estimation::turns_per_rad<Scalar>;
        return feed_mm_s / input.programmed_feed_mm_s;
    }

    struct Wish {
        Scalar ratio;
        Limit limit;
        void cap(Scalar ceiling, Limit reason) {
            if (!(ratio <= ceiling)) {
                ratio = ceiling;
                limit = reason;
            }
        }
    };

    [[nodiscard]] Scalar wanted_ratio(const ControlInput<Scalar>& input, Limit& limit) {
        if (state_ == CutState::fault) {
            return parameters_.override_min;
        }
        Wish wish{parameters_.override_max, Limit::override_max};
        const bool feed_is_known = input.programmed_feed_mm_s > Scalar(0) && is_finite(input.programmed_feed_mm_s);
        const bool speed_is_known =
            input.cut.spindle_speed_rad_s > Scalar(0) && is_finite(input.cut.spindle_speed_rad_s);
        if (!(feed_is_known && speed_is_known)) {
            wish.cap(ratio_, Limit::no_estimate);
        }
        if (feed_is_known && !input.rapid && input.programmed_feed_mm_s > highest_feed_mm_s_) {
            highest_feed_mm_s_ = input.programmed_feed_mm_s;
        }
        if (feed_is_known && speed_is_known) {
            cap_by_state(wish, input);
            wish.cap(ratio_of_feed_per_tooth(parameters_.max_feed_per_tooth_mm, input), Limit::feed_per_tooth);
            cap_by_force(wish, input);
            if (parameters_.Ra_limit_um > Scalar(0)) {
                cap_by_surface(wish, input);
            }
        }
        if (input.rapid) {
            wish = {Scalar(1), Limit::none};  // a rapid is the program's word that nothing is in the way
        }
        if (state_ == CutState::hold) {
            wish.cap(ratio_, Limit::no_estimate);
        }
        if (input.operator_override < Scalar(1) || !is_finite(input.operator_override)) {
            wish.cap(is_finite(input.operator_override) ? input.operator_override : Scalar(0), Limit::operator_limit);
        }
        if (wish.ratio <= parameters_.override_min) {
            wish.limit = wish.limit == Limit::operator_limit ? wish.limit : Limit::override_min;
        }
        limit = wish.limit;
        return bounded(wish.ratio);
    }

    void cap_by_state(Wish& wish, const ControlInput<Scalar>& input) const {
        // Before contact the ceilings hold for the highest F that may come: the next block's F acts at once, the
        // override on it only after the latency.
        const bool is_slower = input.programmed_feed_mm_s < highest_feed_mm_s_;
        const Scalar before_contact = is_slower ? input.programmed_feed_mm_s / highest_feed_mm_s_ : Scalar(1);
        const Scalar air = before_contact * ratio_of_feed_per_tooth(parameters_.air_feed_per_tooth_mm, input);
        if (state_ == CutState::air) {
            wish.cap(air, Limit::air_feed);
        }
        if (input.plunging) {  // not what the law describes
            wish.cap(air < Scalar(1) ? air : Scalar(1), Limit::entry_feed);
        }
        if (state_ == CutState::entry) {
            const Scalar entry = ratio_of_feed_per_tooth(parameters_.entry_feed_per_tooth_mm, input);
            wish.cap(ratio_at_entry_ > entry ? ratio_at_entry_ : entry, Limit::entry_feed);
        }
        if (state_ == CutState::exit) {
            wish.cap(ratio_at_entry_ >= Scalar(0) ? ratio_at_entry_ : ratio_, Limit::no_estimate);
        }
    }

    /// (f/f₀)^(1+p_s) at which a force that is `force_N` now would be `share` of the tooth's limit.
    [[nodiscard]] Scalar growth_to(Scalar share, Scalar force_N, Scalar cutting_share) const {
        constexpr Scalar least_share = static_cast<Scalar>(0.05L);
        const Scalar c = cutting_share > least_share ? cutting_share : least_share;
        return (share * parameters_.tooth_force_limit_N / force_N - (Scalar(1) - c)) / c;
    }

    /// The override that goes with it.
    [[nodiscard, gnu::noinline]] static Scalar feed_at(Scalar growth, const ControlInput<Scalar>& input) {
        using estimation::elementary::exp;
        using estimation::elementary::log;
        if (!(growth > Scalar(0))) {
            return Scalar(0);
        }
        return input.cut.feed_mm_s * exp(log(growth) / input.cut.feed_exponent) / input.programmed_feed_mm_s;
    }

    /// The immersion behind the force is not known: the arc of a cutter that enters follows no law, or a bound is all.
    [[nodiscard]] bool is_ignorant(const CutEstimateForControl<Scalar>& cut) const {
        return state_ == CutState::entry || cut.tooth_force_is_bound || !cut.tooth_force_valid;
    }

    /// Ignorance alone asks for no less than the entry feed: it is the feed that is safe whatever the tool meets. Only
    /// the force that is there at least can.
    [[nodiscard]] Scalar not_below_entry_feed(Scalar demand, const ControlInput<Scalar>& input) const {
        const CutEstimateForControl<Scalar>& cut = input.cut;
        const Scalar entry = ratio_of_feed_per_tooth(parameters_.entry_feed_per_tooth_mm, input);
        if (!(demand < entry) || !(cut.least_tooth_force_N > Scalar(0))) {
            return demand < entry ? entry : demand;
        }
        const Scalar certain =
            feed_at(growth_to(parameters_.setpoint_share, cut.least_tooth_force_N, cut.cutting_share), input);
        const Scalar floor = entry < certain ? entry : certain;
        return demand > floor ? demand : floor;
    }

    /// The law. Remembers its last demand: between two tooth periods the override keeps moving towards it.
    void cap_by_force(Wish& wish, const ControlInput<Scalar>& input) {
        const CutEstimateForControl<Scalar>& cut = input.cut;
        if (state_ == CutState::air || state_ == CutState::exit) {
            demand_ = parameters_.override_max;
            trend_.clear();
            return;
        }
        const bool usable = cut.force_valid && cut.tooth_force_N > Scalar(0) && cut.feed_mm_s > Scalar(0) &&
                            cut.feed_exponent > Scalar(0) && is_finite(cut.tooth_force_N) && is_finite(cut.feed_mm_s) &&
                            is_finite(cut.feed_exponent) && is_finite(cut.cutting_share) &&
                            is_finite(cut.surge_ratio) && is_finite(cut.surge_cutting_share);
        if (cut.fresh && usable) {
            set_demand(input);
            trend_.update(cut.section_mm2, cut.section_noise_mm2, way_since_estimate_mm_);
            way_since_estimate_mm_ = Scalar(0);
            if (state_ != CutState::in_cut) {
                trend_.forget_growth();  // an entry has its own ceiling
            }
        }
        if (!usable || !cut.tooth_force_valid) {
            wish.cap(ratio_, Limit::no_estimate);
        }
        if (trend_.fading()) {
            wish.cap(ratio_, Limit::surge);
        }
        cap_in_surge(wish);
        wish.cap(demand_, demand_limit_);
        cap_after_turn(wish, input, usable);
    }

    /// The surge that may come is under way: the feed that was to meet it holds until it is over.
    void cap_in_surge(Wish& wish) {
        if (parameters_.surge_radial_immersion > Scalar(0) && trend_.growing()) {
            wish.cap(ratio_before_growth_, Limit::surge);
        } else {
            ratio_before_growth_ = ratio_;
        }
    }

    void set_demand(const ControlInput<Scalar>& input) {
        const CutEstimateForControl<Scalar>& cut = input.cut;
        const Scalar growth = growth_to(parameters_.setpoint_share, cut.tooth_force_N, cut.cutting_share);
        const bool may_surge = parameters_.surge_radial_immersion > Scalar(0) && cut.surge_ratio > Scalar(1);
        const Scalar before_surge =
            may_surge ? growth_to(parameters_.surge_share, cut.tooth_force_N * cut.surge_ratio, cut.surge_cutting_share)
                      : growth;
        if (is_ignorant(cut)) {
            demand_limit_ = Limit::force;
            demand_ = not_below_entry_feed(feed_at(growth, input), input);
            const Scalar surge_feed = may_surge ? feed_at(before_surge, input) : demand_;
            if (surge_feed < demand_) {
                demand_ = surge_feed;
                demand_limit_ = Limit::surge;
            }
        } else {  // the lower growth is the lower feed
            demand_limit_ = before_surge < growth ? Limit::surge : Limit::force;
            demand_ = feed_at(before_surge < growth ? before_surge : growth, input);
        }
    }

    /// After a sharp turn the tool may meet anything up to the turn's immersion: the feed that such a cut would allow.
    void cap_after_turn(Wish& wish, const ControlInput<Scalar>& input, bool usable) {
        const CutEstimateForControl<Scalar>& cut = input.cut;
        if (!(turn_travel_left_mm_ > Scalar(0)) || !(parameters_.turn_radial_immersion > Scalar(0))) {
            turn_demand_ = parameters_.override_max;
            return;
        }
        const bool known = usable && is_finite(cut.turn_ratio) && is_finite(cut.turn_cutting_share);
        if (known && (turned_now_ || cut.fresh)) {
            turn_demand_ = cut.turn_ratio > Scalar(1)
                               ? feed_at(growth_to(parameters_.surge_share, cut.tooth_force_N * cut.turn_ratio,
                                                   cut.turn_cutting_share),
                                         input)
                               : parameters_.override_max;
        }
        wish.cap(turn_demand_, Limit::surge);
    }

    /// Remembers the last ceiling of the cut. Without a prediction, or outside the range of its tests, the feed may
    /// fall but not rise.
    void cap_by_surface(Wish& wish, const ControlInput<Scalar>& input) {
        if (state_ == CutState::air || state_ == CutState::exit) {
            surface_ceiling_ = parameters_.override_max;
            return;
        }
        const SurfaceForControl<Scalar>& surface = input.surface;
        const bool usable =
            surface.valid && surface.feed_ceiling_mm_s > Scalar(0) && is_finite(surface.feed_ceiling_mm_s);
        if (usable && input.cut.fresh) {
            const Scalar ceiling = surface.feed_ceiling_mm_s / input.programmed_feed_mm_s;
            surface_ceiling_ = surface.in_range || ceiling < surface_ceiling_ ? ceiling : surface_ceiling_;
        }
        if (!usable || !surface.in_range) {
            wish.cap(ratio_, Limit::no_estimate);
        }
        wish.cap(surface_ceiling_, Limit::roughness);
    }

    void approach(Scalar wanted, const ControlInput<Scalar>& input) {
        if (wanted < ratio_ || !is_finite(ratio_)) {
            const Scalar lowest = ratio_ - parameters_.slew_down_per_s * dt_s_;
            ratio_ = bounded(wanted < lowest ? lowest : wanted);
            return;
        }
        const bool cutting = state_ == CutState::in_cut || state_ == CutState::entry;
        if (cutting && since_estimate_s_ > parameters_.teeth * tooth_period_s_) {
            return;  // an estimate is good for a rise of one revolution
        }
        const Scalar paced = recovery_per_rad_ * input.cut.spindle_speed_rad_s * dt_s_;
        const Scalar share = cutting ? (paced > Scalar(0) ? paced : Scalar(0)) : Scalar(1);
        const Scalar rise = share < Scalar(1) ? (wanted - ratio_) * share : wanted - ratio_;
        const Scalar most = parameters_.slew_up_per_s * dt_s_;
        ratio_ = bounded(ratio_ + (rise > most ? most : rise));
    }

    FeedControllerParameters<Scalar> parameters_;
    Scalar recovery_per_rad_;
    Scalar dt_s_{0};  // of this step, as are the next two
    Scalar path_speed_mm_s_{0};
    Scalar way_mm_{0};
    CutState state_ = CutState::air;
    Fault fault_ = Fault::none;
    Limit limit_ = Limit::none;
    Limit demand_limit_ = Limit::force;
    bool has_cut_ = false;  // since the tool was last in air
    bool turned_now_ = false;
    Scalar ratio_{0};
    Scalar highest_feed_mm_s_{0};
    Scalar ratio_at_entry_{-1};
    Scalar demand_{0};
    Scalar surface_ceiling_{0};
    Scalar travel_in_state_mm_{0};
    Scalar periods_in_state_{0};  // of teeth: counted, a revolution is no sum of rounded shares
    Scalar silent_s_{0};
    Scalar stopped_s_{0};
    Scalar overload_periods_{0};
    CutTrend<Scalar> trend_{};
    Scalar ratio_before_growth_{0};
    Scalar way_since_estimate_mm_{0};
    Scalar since_estimate_s_{0};
    PathTurn<Scalar> turn_{};
    Scalar turn_travel_left_mm_{0};
    Scalar turn_demand_{0};
    Scalar tooth_period_s_{0};
    Basis basis_{};
    Scalar wanted_{0};
};

}  // namespace millforce::control
