// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace millforce::host {

/// One line on the terminal that says how far long work has come; silent where standard error is not a terminal, and
/// for the first half second. After some seconds it also says how many are left. The line is removed in the end.
class Progress {
  public:
    explicit Progress(std::string what, unsigned calls_per_look = 256);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// 0…1; cheap enough to call per row.
    void update(double fraction);

    /// Work whose share is not known: what it is at.
    void show(const std::string& state);

  private:
    [[nodiscard]] bool is_time_to_show();

    std::string what_;
    bool terminal_;
    bool shown_ = false;
    unsigned calls_per_look_;
    unsigned calls_ = 0;
    double start_s_;
    double last_s_;
};

}  // namespace millforce::host
