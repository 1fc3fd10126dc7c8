#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimation/depth_monitor.hpp"
#include "estimation/force_drop.hpp"
#include "firmware/parameters.hpp"
#include "loop/recording.hpp"

/// The wide-band methods on a recorded force sensor: radial immersion from force drops (Hwang et al.) and both depths
/// from the shape of the force (Yang, DeVor & Kapoor).

namespace millforce::sim {

/// Turns plane forces and the spindle's angle into the feed's frame: x along the feed, y its normal. The frame stays
/// until the feed has turned by more than 3°; then what is being averaged has to start anew.
class FeedFrame {
  public:
    struct Turned {
        bool valid = false;  ///< the feed moves, and the cell of each quantity was there
        bool is_new = false;
        float spindle_angle_rev = 0.0F;  ///< 0…1
        float along_N = 0.0F;
        float across_N = 0.0F;
    };
    Turned turn(const ForceSensorSample& sample);

  private:
    bool has_direction_ = false;
    double direction_rad_ = 0.0;
};

/// What the methods say at this moment; not valid: no estimate. An estimate stays until the next one is due.
struct WideBandEstimate {
    estimation::Measurement<float> force_drop_immersion{};
    estimation::Measurement<float> axial_depth_mm{};
    estimation::Measurement<float> radial_width_mm{};
};

class ForceSensorEstimates {
  public:
    explicit ForceSensorEstimates(const firmware::Parameters<float>& parameters);

    void add(const ForceSensorSample& sample);
    [[nodiscard]] const WideBandEstimate& estimate() const { return estimate_; }

    /// One line per method that cannot run: what the tool's file lacks.
    [[nodiscard]] const std::vector<std::string>& missing() const { return missing_; }
    /// "force drops: 12 estimates of 14; depths by shape: 3 of 3"; empty where neither method runs.
    [[nodiscard]] std::string summary() const;

  private:
    struct Count {
        int due = 0;
        int valid = 0;
    };
    /// Path and rotation since the last estimate: their ratio is the feed per tooth.
    struct Travel {
        double path_mm = 0.0;
        double turned_rev = 0.0;
    };

    void make_force_drop();
    void make_depth_monitor();
    void restart();
    void follow(const ForceSensorSample& sample, const FeedFrame::Turned& turned);
    void add_force_drop(const FeedFrame::Turned& turned, float dt_s);
    void add_depths(const FeedFrame::Turned& turned, float dt_s);
    void drop_outdated();

    firmware::ToolParameters<float> tool_;
    std::optional<estimation::ForceDrop<float>> force_drop_;
    std::optional<estimation::DepthMonitor<float>> depths_;
    std::vector<std::string> missing_;
    WideBandEstimate estimate_{};
    FeedFrame frame_;
    Travel force_drop_travel_;
    Travel depth_travel_;
    Count force_drop_count_;
    Count depth_count_;
    double last_time_s_ = no_estimate;
    float last_angle_rev_ = 0.0F;
};

}  // namespace millforce::sim
