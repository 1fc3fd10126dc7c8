// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "loop/override_source.hpp"
#include "loop/scenario.hpp"
#include "remote/line_socket.hpp"
#include "remote/outside_controller.hpp"

namespace millforce::sim {

/// A controller in another process, in any language: it listens at a Unix socket, this connects. In lock-step: one
/// sample goes out, one override comes back, and the plant waits for it as long as `patience`. The same answers give
/// the same run, however long they take.
///
/// The constructor and step() throw InputError where the controller dies, is silent, or answers what no CNC would take;
/// it is told why before the connection ends.
class SocketController : public OverrideSource {
  public:
    SocketController(const Scenario& scenario, const std::string& path, LineSocket::Patience patience);

    [[nodiscard]] const std::string& name() const { return name_; }
    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override;
    void describe(TracePoint& point) const override { controller_.describe(point); }
    /// Tells the controller how the run ended.
    void end(const RunFigures& figures);

  private:
    [[nodiscard]] std::string greet(const Scenario& scenario);
    [[nodiscard]] hal::FeedOverride ask(const hal::DriveSample& sample, const hal::ProgramStatus& program);
    void say_last(const std::string& message);
    [[noreturn]] void give_up(const std::string& why);

    std::string path_;
    LineSocket socket_;
    std::string name_;
    OutsideController controller_;
};

}  // namespace millforce::sim
