// SPDX-License-Identifier: Apache-2.0
#include "calibration/roughness_calibration.hpp"

#include "calibration/calibration_report.hpp"
#include "calibration/duplicate_rows.hpp"
#include "calibration/plausible_units.hpp"
#include "estimation/number/student_t.hpp"
#include "estimation_calibration/roughness_in_double.hpp"
#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "parameters/parameter_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace millforce::host {

namespace {

using estimation::RoughnessFit;
using Test = estimation::RoughnessTest;

constexpr int variables = estimation::roughness_variable_count;

/// Order of estimation::RoughnessVariable.
const std::array<CalibrationKey, 5> exponent_keys{{
    key_of("roughness", "spindle_speed_exponent"),
    key_of("roughness", "feed_exponent"),
    key_of("roughness", "tool_diameter_exponent"),
    key_of("roughness", "axial_depth_exponent"),
    key_of("roughness", "force_ratio_exponent"),
}};
const CalibrationKey constant_key = key_of("roughness", "constant_um");
const CalibrationKey middle_key = key_of("roughness", "roughness_at_means_um");
const CalibrationKey determination_key = key_of("roughness", "determination");

/// A test and its place in the file, for the report.
struct TestRow {
    Test test;
    std::string place;
};

const char* column_of(int variable) {
    return roughness_columns[static_cast<std::size_t>(variable)];
}

std::string measure_of(const RoughnessCalibrationOptions& options) {
    return !options.measure.empty()                                    ? options.measure
           : CsvReader(options.data.front()).find("Ra_um").has_value() ? "Ra"
                                                                       : "Rz";
}

/// |F_x/F_z| of a row: as it is given, or from the two forces.
class RatioColumns {
  public:
    explicit RatioColumns(const CsvReader& csv) : ratio_(csv.find("force_ratio")) {
        if (!ratio_) {
            const std::string reason = "nor 'force_ratio'";
            feed_ = csv.require("feed_force_N", reason);
            axial_ = csv.require("axial_force_N", reason);
        }
    }
    double of(const CsvReader& csv) const {
        constexpr double largest_N = 1e6;
        if (ratio_) {
            return csv.required_number(*ratio_, 1e-4, 1e4);
        }
        const double feed_N = std::abs(csv.required_number(*feed_, -largest_N, largest_N));
        const double axial_N = std::abs(csv.required_number(*axial_, -largest_N, largest_N));
        const auto refuse_zero = [&](double force_N, CsvColumn column) {
            if (force_N == 0.0) {
                csv.fail(column, "0 N; expected a force, of which a ratio can be taken");
            }
        };
        refuse_zero(feed_N, *feed_);
        refuse_zero(axial_N, *axial_);
        return feed_N / axial_N;
    }

  private:
    std::optional<CsvColumn> ratio_, feed_, axial_;
};

void read_tests(const std::filesystem::path& file, const std::string& measure, DuplicateRows& duplicates,
                std::vector<TestRow>& rows) {
    CsvReader csv(file);
    const CsvColumn speed = csv.require(roughness_columns[0]);
    const CsvColumn feed = csv.require(roughness_columns[1]);
    const CsvColumn diameter = csv.require(roughness_columns[2]);
    const CsvColumn depth = csv.require(roughness_columns[3]);
    const RatioColumns ratio(csv);
    const CsvColumn roughness = csv.require(measure + "_um", "the measured roughness");
    while (csv.next_row()) {
        if (std::isnan(csv.number(roughness)) || duplicates.is_copy(csv)) {
            continue;
        }
        const estimation::RoughnessConditions<double> cut{
            csv.required_number(speed, 1.0, 1e6), csv.required_number(feed, 1e-6, 1e3),
            csv.required_number(diameter, 0.01, 1e3), csv.required_number(depth, 1e-4, 1e3), ratio.of(csv)};
        rows.push_back({{cut, csv.required_number(roughness, 1e-4, 1e4)},
                        fmt::format("{}:{}", csv.file_name(), csv.line_number())});
    }
}

UnitQuestions look_at_units(const std::vector<TestRow>& rows, const std::string& measure) {
    std::vector<RoughnessUnits> tests;
    tests.reserve(rows.size());
    for (const auto& [test, place] : rows) {
        const auto& [speed_rpm, feed_mm_rev, diameter_mm, depth_mm, force_ratio] = test.cut;
        tests.push_back({place, speed_rpm, feed_mm_rev, diameter_mm, depth_mm, force_ratio, test.roughness_um});
    }
    return look_at_roughness_tests(tests, measure);
}

unsigned held_bits(const RoughnessCalibrationOptions& options) {
    unsigned bits = 0U;
    for (const std::string& name : options.held) {
        const auto* const found = std::find(roughness_columns.begin(), roughness_columns.end(), name);
        if (found == roughness_columns.end()) {
            throw InputError(fmt::format("--hold {}: expected one of {}", name, fmt::join(roughness_columns, ", ")));
        }
        bits |= 1U << static_cast<unsigned>(found - roughness_columns.begin());
    }
    return bits;
}

RoughnessFit fit_without(const std::vector<TestRow>& rows, std::size_t left_out, unsigned held) {
    std::vector<Test> tests;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (k != left_out) {
            tests.push_back(rows[k].test);
        }
    }
    return estimation::fit_roughness(tests, held);
}

/// An exponent that the tests cannot determine, and the variation that is missing.
std::string what_the_tests_lack(const RoughnessFit& fit) {
    if (fit.degrees_of_freedom < 1) {
        return fmt::format(
            "'residual_ln_sd' cannot be determined: {} tests with a measured roughness; expected at least "
            "{}, one more than parameters",
            fit.tests, fit.tests + 1 - fit.degrees_of_freedom);
    }
    for (int j = 0; j < variables; ++j) {
        if (fit.determined(j)) {
            continue;
        }
        const auto k = static_cast<std::size_t>(j);
        const int other = fit.variable_it_goes_with(j);
        if (other < 0) {
            return fmt::format(
                "'{}' cannot be determined: all tests have {} of about {:.4g}; expected tests at clearly different "
                "values, or --hold {}",
                exponent_keys[k].name, column_of(j), fit.model.reference[k], column_of(j));
        }
        return fmt::format(
            "'{}' cannot be determined: {} changes only along with other columns, {} above all; expected "
            "tests that change {} alone",
            exponent_keys[k].name, column_of(j), column_of(other), column_of(j));
    }
    return {};
}

void print_model(std::ostream& out, const std::string& measure, const RoughnessFit& fit, unsigned held,
                 const std::vector<TestRow>& rows) {
    const auto& model = fit.model;
    out << fmt::format("{} = C V^a f^b phi^c D^d (F_x/F_z)^e, {} tests, {} degrees of freedom\n", measure, fit.tests,
                       fit.degrees_of_freedom);
    print_fitted(out, {constant_key, model.constant_um, model.constant_um * fit.constant_ln_standard_error});
    for (int j = 0; j < variables; ++j) {
        const auto k = static_cast<std::size_t>(j);
        if (((held >> static_cast<unsigned>(j)) & 1U) != 0U) {
            out << fmt::format("  {:<40} held at {} = {:.4g}\n", exponent_keys[k].name, column_of(j),
                               model.reference[k]);
        } else {
            print_fitted(out, {exponent_keys[k], model.exponent[k], fit.exponent_standard_error[k]});
        }
    }
    print_fitted(out, {middle_key, fit.reference_um, fit.reference_um * fit.reference_ln_standard_error});
    const double half =
        estimation::student_t_975(model.degrees_of_freedom) * model.residual_ln_sd * std::sqrt(1.0 + 1.0 / model.tests);
    out << fmt::format("  tests scatter {:.1f} % about the model, which explains {:.1f} % of the variance of ln {}\n",
                       100.0 * model.residual_ln_sd, 100.0 * fit.determination, measure);
    out << fmt::format("  95 % of new tests lie within {:.3f} to {:.3f} times the prediction, at the tests' middle\n",
                       std::exp(-half), std::exp(half));
    if (fit.worst_test >= 0) {
        out << fmt::format("  furthest off: {}, {:.1f} standard deviations\n",
                           rows[static_cast<std::size_t>(fit.worst_test)].place, fit.worst_residual);
    }
}

/// Each test predicted by the model of all others; whether as many lie in their intervals as is stated.
bool check_left_out(std::ostream& out, const std::vector<TestRow>& rows, unsigned held) {
    constexpr double share_within = 0.85;  // with 36 good tests, 99 of 100 series keep it
    int within = 0;
    int asked = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const auto fit = fit_without(rows, k, held);
        if (!fit.is_determined()) {
            continue;
        }
        const auto prediction = estimation::RoughnessPredictor<double>(fit.model).predict(rows[k].test.cut);
        const double R = rows[k].test.roughness_um;
        ++asked;
        within += prediction.has_interval && R >= prediction.low_um && R <= prediction.high_um ? 1 : 0;
    }
    if (asked == 0) {
        out << "too few tests to leave any out: the interval is unchecked\n";
        return true;
    }
    const bool holds = within >= share_within * asked;
    out << fmt::format("{} of {} tests in the 95 % interval of the model without them, bound {:.0f} %: {}\n", within,
                       asked, 100.0 * share_within, holds ? "holds" : "BROKEN");
    return holds;
}

/// C holds for 1 rpm, 1 mm/rev and so on, far outside of the tests: neither it nor its error need be numbers that a
/// tool file takes. If C is below the smallest value, the data are not
/// cutting tests.
double constant_standard_error(const RoughnessFit& fit) {
    constexpr double smallest_um = 1e-30;  // float keeps it
    constexpr double largest_error_um = 1e12;
    if (!(fit.model.constant_um >= smallest_um)) {
        throw InputError(fmt::format("the data give 'constant_um' = {:.6g} um; expected a value from {} to {}",
                                     fit.model.constant_um, smallest_um, constant_key.maximum));
    }
    const double error_um = fit.model.constant_um * fit.constant_ln_standard_error;
    return error_um <= largest_error_um ? error_um : no_estimate;
}

/// Of the exponents and the constant; other keys have none.
double standard_error_of(std::string_view key, const RoughnessFit& fit) {
    for (std::size_t k = 0; k < exponent_keys.size(); ++k) {
        if (exponent_keys[k].name == key) {
            return fit.exponent_standard_error[k];
        }
    }
    return key == constant_key.name ? constant_standard_error(fit) : no_estimate;
}

void write_model(const RoughnessCalibrationOptions& options, const std::string& measure, const RoughnessFit& fit) {
    AtomicFile file(options.output);
    TomlWriter toml(file.stream());
    toml.comment("Surface roughness: R = C V^a f^b phi^c D^d (F_x/F_z)^e, V in rpm, f in mm/rev, phi and D in mm.");
    toml.comment("Fitted from " + list_of_files(options.data));
    toml.table("roughness");
    firmware::Parameters<double> parameters;
    parameters.tool.roughness = fit.model;
    const auto write = [&]<typename Field>(const firmware::ParameterName& name, const Field& field, float minimum,
                                           float maximum) {
        if (std::string_view(name.table) != "roughness") {
            return;
        }
        if constexpr (std::is_enum_v<Field>) {
            toml.key(name.key, measure);
        } else {
            const CalibrationKey key{name.key, row_of(name).unit, minimum, maximum};
            write_fitted(toml, {key, static_cast<double>(field), standard_error_of(name.key, fit)});
        }
    };
    firmware::for_each_parameter(parameters, write);
    write_fitted(toml, {middle_key, fit.reference_um, fit.reference_um * fit.reference_ln_standard_error});
    toml.key(determination_key.name, fit.determination);
    file.commit();
}

}  // namespace

int calibrate_roughness(const RoughnessCalibrationOptions& options, std::ostream& out) {
    if (options.data.empty()) {
        throw InputError("calibrate roughness: no data file; expected at least one CSV file of cutting tests");
    }
    const unsigned held = held_bits(options);
    const std::string measure = measure_of(options);
    std::vector<TestRow> rows;
    DuplicateRows duplicates;
    for (const auto& file : options.data) {
        read_tests(file, measure, duplicates, rows);
    }
    duplicates.report(out);
    const UnitQuestions questions = look_at_units(rows, measure);
    const auto fit = fit_without(rows, rows.size(), held);
    const std::string lack = what_the_tests_lack(fit);
    if (!lack.empty()) {
        throw InputError(fmt::format("{}: {}", options.data.front().string(), lack));
    }
    print_model(out, measure, fit, held, rows);
    const bool holds = check_left_out(out, rows, held);
    write_model(options, measure, fit);
    return ask(out, questions, holds ? exit_done : exit_bound_broken);
}

}  // namespace millforce::host
