// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Everything of estimation, control and the tick that their headers declare and do not define. Include it in one file
/// of a program, and the program needs headers alone: no library of this project is built or linked. That file takes as
/// long to compile as the libraries do, some 20 s.
///
/// Include paths: where the package is installed, its `include/millforce`; in the tree, its root, and `include` in
/// hal, estimation, control and firmware. CMake's target millforce::core_in_one_file has them. With GCC and clang add
/// -ffp-contract=off, and the results have the same bits on every processor.

#include "control/src/ceilings.cpp"
#include "control/src/cut_states.cpp"
#include "control/src/cut_trend.cpp"
#include "control/src/feed_ahead.cpp"
#include "control/src/feed_controller.cpp"
#include "control/src/feed_law.cpp"
#include "control/src/path_turn.cpp"
#include "control/src/spindle_torque.cpp"
#include "estimation/src/cut_estimator_fixed.cpp"
#include "estimation/src/cut_estimator_float.cpp"
#include "estimation/src/cutting_law.cpp"
#include "estimation/src/depth_monitor.cpp"
#include "estimation/src/depth_variation.cpp"
#include "estimation/src/elementary.cpp"
#include "estimation/src/estimators.cpp"
#include "estimation/src/force_drop.cpp"
#include "estimation/src/peak_table.cpp"
#include "estimation/src/roughness.cpp"
#include "firmware/src/parameter_block.cpp"
#include "firmware/src/parameter_values.cpp"
#include "firmware/src/signal_supervisor.cpp"
#include "firmware/src/tick_fixed.cpp"
#include "firmware/src/tick_float.cpp"
#include "firmware/src/tick_record.cpp"
#include "firmware/src/tool_checksum.cpp"
#include "firmware/src/tool_tick.cpp"
#include "firmware/src/usable_signals.cpp"
#include "firmware/src/wide_band_fixed.cpp"
#include "firmware/src/wide_band_float.cpp"
