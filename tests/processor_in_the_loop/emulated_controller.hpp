// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "emulator_pipes.hpp"
#include "firmware/parameters_in.hpp"
#include "target/lock_step.hpp"

namespace millforce {

/// A controller image in an emulator, one request and one answer per sample.
class EmulatedController {
  public:
    EmulatedController(const std::string& processor, const firmware::Parameters<float>& parameters) {
        const std::string source = MILLFORCE_SOURCE_DIR;
        pipes_.start({source + "/toolchains/run-on-mps2", processor,
                      source + "/build/" + processor + "/tests/target/lock_step_controller.elf"});
        pipes_.send(firmware::values_of(parameters));
    }

    [[nodiscard]] bool works() const { return pipes_.works(); }

    lock_step::Answer step(const lock_step::Request& request) {
        pipes_.send(request);
        return pipes_.hear<lock_step::Answer>();
    }

  private:
    EmulatorPipes pipes_;
};

}  // namespace millforce
