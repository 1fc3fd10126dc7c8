// SPDX-License-Identifier: Apache-2.0
#include "calibration/cutting_calibration.hpp"
#include "calibration/friction_calibration.hpp"
#include "calibration/roughness_calibration.hpp"
#include "calibration/spindle_calibration.hpp"
#include "calibration/standard_cut_calibration.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <sstream>
#include <string>

using namespace millforce::host;
using namespace millforce::test;

namespace {

template <typename Options>
std::string refusal_of(int (*calibrate)(const Options&, std::ostream&)) {
    std::ostringstream out;
    return message_of<InputError>([&] { static_cast<void>(calibrate(Options{}, out)); });
}

}  // namespace

TEST_GROUP(Calibrations){};

TEST(Calibrations, without_a_data_file_name_the_command_that_lacks_it) {
    STRCMP_CONTAINS("calibrate cutting: no data file", refusal_of(calibrate_cutting).c_str());
    STRCMP_CONTAINS("calibrate friction: no data file", refusal_of(calibrate_friction).c_str());
    STRCMP_CONTAINS("calibrate roughness: no data file", refusal_of(calibrate_roughness).c_str());
    STRCMP_CONTAINS("calibrate spindle: no data file", refusal_of(calibrate_spindle).c_str());
    STRCMP_CONTAINS("calibrate standard-cut: no data file", refusal_of(calibrate_standard_cut).c_str());
}
