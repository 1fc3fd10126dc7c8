// SPDX-License-Identifier: Apache-2.0
#include "calibration/spindle_calibration.hpp"

#include "calibration/calibration_report.hpp"
#include "calibration/duplicate_rows.hpp"
#include "calibration/plausible_drives.hpp"
#include "calibration/signal.hpp"
#include "calibration/spindle_rows.hpp"
#include "estimation_calibration/spindle_fit.hpp"
#include "files/atomic_file.hpp"
#include "files/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace millforce::host {

namespace {

using Sample = estimation::SpindleSample;
using KnownTorques = KnownSpindleTorques;

estimation::SpindleFitTerms terms_for(const std::vector<Sample>& samples) {
    double slowest = samples.front().speed_rad_s;
    double fastest = slowest;
    double acceleration = 0.0;
    for (const Sample& s : samples) {
        slowest = std::min(slowest, s.speed_rad_s);
        fastest = std::max(fastest, s.speed_rad_s);
        acceleration = std::max(acceleration, std::abs(s.acceleration_rad_s2));
    }
    return {fastest > 1.1 * slowest, acceleration > 1.0, fastest > 1.2 * slowest};
}

double correlation(const std::vector<Sample>& samples, const estimation::SpindleFit& fit) {
    std::vector<double> residuals;
    residuals.reserve(samples.size());
    for (const Sample& s : samples) {
        residuals.push_back(s.torque_Nm - estimation::spindle_torque_Nm(fit, s));
    }
    return correlated_samples(residuals);
}

/// What the rows say without their outliers, and without the terms that they do not determine.
struct SpindleResult {
    estimation::SpindleFit fit{};
    estimation::SpindleFitTerms terms{};
    double correlated = 1.0;
    std::vector<Sample> kept;
    std::vector<std::size_t> outliers;
    std::vector<FittedValue> left_out;

    [[nodiscard]] double value(int j) const { return fit.solution.parameters(j); }
    [[nodiscard]] double error(int j) const { return fit.solution.standard_error(j) * std::sqrt(correlated); }
};

bool& term_of(estimation::SpindleFitTerms& terms, int parameter) {
    return parameter == estimation::spindle_K_t2         ? terms.idle_torque
           : parameter == estimation::spindle_idle_slope ? terms.idle_slope
                                                         : terms.inertia;
}

SpindleResult fit_without_outliers(const std::vector<Sample>& samples, estimation::SpindleFitTerms terms) {
    const auto trimmed = estimation::fit_spindle_without_outliers(samples, terms);
    SpindleResult result;
    result.fit = trimmed.fit;
    result.terms = terms;
    result.outliers = trimmed.outliers;
    auto outlier = trimmed.outliers.begin();
    for (std::size_t k = 0; k < samples.size(); ++k) {
        if (outlier != trimmed.outliers.end() && *outlier == k) {
            ++outlier;
        } else {
            result.kept.push_back(samples[k]);
        }
    }
    result.correlated = correlation(result.kept, result.fit);
    return result;
}

/// Terms that are smaller than their standard error are left out, one by one.
void leave_out_vague_terms(SpindleResult& result) {
    using namespace estimation;
    std::vector<int> candidates;
    for (const int j : {spindle_K_t2, spindle_idle_slope, spindle_inertia}) {
        if (term_of(result.terms, j)) {
            candidates.push_back(j);
        }
    }
    while (const auto vague = most_vague(result.fit.solution, candidates, std::sqrt(result.correlated))) {
        std::erase(candidates, *vague);
        result.left_out.push_back(
            {spindle_keys[static_cast<std::size_t>(*vague)], result.value(*vague), result.error(*vague)});
        term_of(result.terms, *vague) = false;
        result.fit = fit_spindle(result.kept, result.terms);
        result.correlated = correlation(result.kept, result.fit);
    }
}

void refuse_what_is_missing(const SpindleCalibrationOptions& options, const std::vector<Sample>& samples,
                            const estimation::SpindleFit& fit, double correlated) {
    const auto refuse = [&](int j, std::string_view why) {
        throw InputError(fmt::format("{}: '{}' cannot be determined: {}", options.data.front().string(),
                                     spindle_keys[static_cast<std::size_t>(j)].name, why));
    };
    const auto [low, high] = std::minmax_element(
        samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.torque_Nm < b.torque_Nm; });
    const auto& s = fit.solution;
    const double gain = s.parameters(estimation::spindle_K_t1);
    const double error = s.standard_error(estimation::spindle_K_t1) * std::sqrt(correlated);
    if (gain < -3.0 * error) {
        throw InputError(
            fmt::format("{}: 'K_t1_Nm_per_A' = {:.4g} ± {:.2g}: the current falls as the torque rises; "
                        "expected spindle_current_A positive where the motor drives; is its sign reversed?",
                        options.data.front().string(), gain, error));
    }
    if (!s.determined(estimation::spindle_K_t1) || !(error < gain / 3.0)) {
        refuse(
            estimation::spindle_K_t1,
            fmt::format("over torques from {:.4g} to {:.4g} N·m the current does not rise with the torque beyond the "
                        "noise; expected idle running and cuts of clearly different known torque",
                        low->torque_Nm, high->torque_Nm));
    }
    if (!s.determined(estimation::spindle_K_t2) || !s.determined(estimation::spindle_idle_slope)) {
        refuse(estimation::spindle_idle_slope,
               "idle torque and load change together with speed; expected idle running "
               "and a cut at each of two speeds");
    }
    if (!s.determined(estimation::spindle_inertia)) {
        refuse(estimation::spindle_inertia,
               "acceleration goes together with speed or current; expected a run-up in air");
    }
}

/// What a fit can give that no spindle has.
void refuse_what_no_spindle_has(const SpindleCalibrationOptions& options, const SpindleResult& result) {
    constexpr double largest_share_of_outliers = 0.2;
    constexpr double least_gain_Nm_per_A = 0.003;
    constexpr double significance = 4.0;
    const std::string file = options.data.front().string();
    const std::size_t rows = result.kept.size() + result.outliers.size();
    if (static_cast<double>(result.outliers.size()) > largest_share_of_outliers * static_cast<double>(rows)) {
        throw InputError(
            fmt::format("{}: {} of {} rows lie far from any fit; expected less than {:.0f} %; are torque and "
                        "current of the same cut in one row?",
                        file, result.outliers.size(), rows, 100.0 * largest_share_of_outliers));
    }
    const double gain = result.value(estimation::spindle_K_t1);
    if (gain < least_gain_Nm_per_A) {
        throw InputError(
            fmt::format("{}: 'K_t1_Nm_per_A' = {:.3g}; expected {:g} or more; is spindle_current_A in mA, or "
                        "spindle_torque_Nm in kN·m?",
                        file, gain, least_gain_Nm_per_A));
    }
    const double inertia = result.value(estimation::spindle_inertia);
    if (inertia < 0.0) {
        throw InputError(
            fmt::format("{}: 'inertia_kg_m2' = {:.4g} ± {:.2g}: the current falls while the spindle gains "
                        "speed; expected the opposite; is the sign of the acceleration reversed?",
                        file, inertia, result.error(estimation::spindle_inertia)));
    }
    double idle_Nm = 0.0;
    double largest_Nm = 0.0;
    for (const Sample& s : result.kept) {
        idle_Nm +=
            (result.value(estimation::spindle_idle_slope) * s.speed_rad_s - result.value(estimation::spindle_K_t2)) /
            static_cast<double>(result.kept.size());
        largest_Nm = std::max(largest_Nm, std::abs(s.torque_Nm));
    }
    constexpr double least_idle_share = 0.05;  // of the largest torque: a converter's offset is smaller
    const double error = result.terms.idle_torque ? result.error(estimation::spindle_K_t2) : 0.0;
    if (idle_Nm < -significance * error && idle_Nm < -least_idle_share * largest_Nm) {
        throw InputError(
            fmt::format("{}: 'K_t2_Nm' = {:.4g}: at idle the current would drive against the rotation; "
                        "expected a positive current at idle; are current and torque both reversed?",
                        file, result.value(estimation::spindle_K_t2)));
    }
}

SpindleLoad strongest_load(const std::vector<Sample>& samples) {
    SpindleLoad strongest;
    for (const Sample& s : samples) {
        const SpindleLoad load{s.torque_Nm, s.speed_rad_s, s.current_A};
        strongest = load.power_W() > strongest.power_W() ? load : strongest;
    }
    return strongest;
}

SpindleSpeeds speeds_of(const SpindleResult& result) {
    SpindleSpeeds speeds;
    for (const Sample& s : result.kept) {
        speeds.speeds_rad_s.push_back(s.speed_rad_s);
    }
    speeds.W_per_A = strongest_load(result.kept).W_per_A();
    speeds.base_speed_rad_s = result.value(estimation::spindle_base_speed);
    speeds.base_speed_W_per_A = result.value(estimation::spindle_K_t1) * speeds.base_speed_rad_s;
    return speeds;
}

void refuse_other_units(const std::string& file, const KnownTorques& known, const SpindleResult& result) {
    const SpeedSource source = known.by_angle ? SpeedSource::angle : SpeedSource::column;
    double fastest_rad_s = 0.0;
    for (const Sample& s : result.kept) {
        fastest_rad_s = std::max(fastest_rad_s, s.speed_rad_s);
    }
    refuse_implausible_spindle_speed(file, fastest_rad_s, source);
    refuse_implausible_power(file, strongest_load(result.kept), source);
}

void print_outliers(std::ostream& out, const KnownTorques& known, const SpindleResult& result) {
    if (result.outliers.empty()) {
        return;
    }
    std::vector<std::string> places;
    for (const std::size_t k : result.outliers) {
        places.push_back(known.places[k]);
    }
    out << fmt::format("{} rows are outliers, more than six robust standard deviations off, and left out: {}\n",
                       places.size(), list_of_places(places));
}

bool is_weakened(const SpindleResult& result) {
    return result.value(estimation::spindle_base_speed) > 0.0;
}

/// The fitted terms, into the file and for the user.
void write_terms(TomlWriter& toml, std::ostream& out, const SpindleResult& result,
                 const estimation::SpindleFitTerms& asked_terms) {
    const bool weakened = is_weakened(result);
    // Field weakening that was looked for and not seen is known to be none; a term that was not fitted is not known.
    const std::array<bool, estimation::spindle_parameter_count> known_terms{
        true, result.terms.idle_torque, result.terms.idle_slope, result.terms.inertia, asked_terms.field_weakening};
    for (std::size_t j = 0; j < known_terms.size(); ++j) {
        const int index = static_cast<int>(j);
        if (!known_terms[j]) {
            continue;
        }
        const bool has_error =
            index != estimation::spindle_base_speed || (weakened && !result.fit.nothing_below_base_speed);
        const FittedValue fitted{spindle_keys[j], result.value(index), has_error ? result.error(index) : no_estimate};
        write_fitted(toml, fitted);
        if (has_error || weakened) {
            print_fitted(out, fitted);
        }
    }
    for (const FittedValue& left_out : result.left_out) {
        print_left_out(out, left_out);
    }
}

void print_what_is_not_seen(std::ostream& out, const SpindleResult& result,
                            const estimation::SpindleFitTerms& asked_terms) {
    if (!asked_terms.idle_slope) {
        out << "  one speed only: idle_torque_slope_Nm_s and field weakening cannot be seen, and are not written\n";
    } else if (asked_terms.field_weakening && !is_weakened(result)) {
        out << "  no field weakening seen between the slowest and the fastest cut\n";
    }
    if (!asked_terms.inertia) {
        out << "  no acceleration of more than 1 rad/s²: inertia_kg_m2 is not written\n";
    }
    if (result.fit.nothing_below_base_speed) {
        out << "  every speed is in field weakening: K_t1_Nm_per_A holds at base_speed_rad_s and falls above it; below "
               "it nothing is known\n";
    }
}

}  // namespace

int calibrate_spindle(const SpindleCalibrationOptions& options, std::ostream& out) {
    if (options.data.empty()) {
        throw InputError("calibrate spindle: no data file; expected at least one CSV file");
    }
    const KnownTorques known = read_known_spindle_torques(options.data, options.low_pass_hz, out);
    const estimation::SpindleFitTerms asked_terms = terms_for(known.samples);
    SpindleResult result = fit_without_outliers(known.samples, asked_terms);
    refuse_what_is_missing(options, result.kept, result.fit, result.correlated);
    leave_out_vague_terms(result);
    refuse_what_no_spindle_has(options, result);
    refuse_other_units(options.data.front().string(), known, result);

    AtomicFile file(options.output);
    TomlWriter toml(file.stream());
    toml.comment("Spindle drive: T = K_t1 g(w) I + K_t2 - k w - J dw/dt; g = 1 up to the base speed, base/w above.");
    toml.comment("Fitted from " + list_of_files(options.data));
    toml.table("spindle");
    out << fmt::format("T = K_t1 g(ω) I + K_t2 − k ω − J dω/dt, {} rows\n", result.kept.size());
    print_outliers(out, known, result);
    write_terms(toml, out, result, asked_terms);
    toml.key(torque_residual_key.name, result.fit.solution.residual_rms);
    file.commit();
    out << fmt::format("  residual {:.4g} N·m rms\n", result.fit.solution.residual_rms);
    print_what_is_not_seen(out, result, asked_terms);
    return ask(out, ask_about_spindle_speeds(speeds_of(result)), exit_done);
}

}  // namespace millforce::host
