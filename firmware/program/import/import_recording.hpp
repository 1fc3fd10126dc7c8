// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "import/import_map.hpp"
#include "import/recording_statistics.hpp"
#include "import/row_builder.hpp"

namespace millforce::host {

struct ImportSettings {
    std::vector<std::string> files;  ///< parts of one recording, in their order: the time goes on from one to the next
    std::string map;                 ///< empty: the columns have our names and units already
    std::string output;              ///< empty: nothing is written
    SourceFormat format = SourceFormat::detected;  ///< else by the map, else by the file
    Resampling resampling{};
};

/// What was read.
struct ImportedFile {
    std::string file;
    std::string description;
    std::vector<std::string> notes;
};

/// What became of it.
struct ImportedRecording {
    std::vector<ImportedFile> files;
    std::vector<ColumnMap> columns;            ///< columns of the recording, without the time
    std::vector<ColumnStatistics> statistics;  ///< one for each column
    StepStatistics steps;
    Resampling resampling{};
    std::vector<std::string> unused_names;  ///< columns of the source that are not used
};

/// Turns files of other programs into a recording (recording/recording.hpp). time_s begins at 0 with the first record
/// and is rounded to ns. The files are read once and never as a whole. The output appears whole or not at all.
///
/// InputError: all that the readers and the map refuse, times that do not grow, signals at different times without
/// resampling, no rows, an output that is one of the files.
[[nodiscard]] ImportedRecording import_recording(const ImportSettings& settings);

/// The recording in words for a terminal: files, rate, gaps, a line and a curve per column, and what cannot be right.
[[nodiscard]] std::string import_report(const ImportedRecording& recording);

}  // namespace millforce::host
