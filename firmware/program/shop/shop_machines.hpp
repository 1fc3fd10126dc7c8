// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <string>
#include <string_view>

#include "report/json_writer.hpp"

namespace millforce::host {

/// What the gateways of a shop's machines have told (gateway/README.md): of each machine whether it is there, its
/// newest state, and its last events and job reports. At most 500 machines; messages above 8 KiB are left out, so that
/// whoever may write to the broker can fill no memory.
class ShopMachines {
  public:
    static constexpr std::size_t most_machines = 500;
    static constexpr std::size_t most_bytes = 8192;
    static constexpr std::size_t most_notes = 10;  ///< events, and reports, of a machine

    /// A message. `levels`: its topic behind the prefix, "vmc1/state".
    void take(std::string_view levels, std::string_view payload);

    /// One object: `machines`, each with `name`, `is_online`, `state`, `events` and `jobs`. The last three are the
    /// messages as text, the newest first: what they hold is for the reader to judge.
    void write(JsonWriter& json) const;

  private:
    struct Machine {
        bool is_online = false;
        std::string state{};
        std::deque<std::string> events{};
        std::deque<std::string> jobs{};
    };

    std::map<std::string, Machine, std::less<>> machines_{};
};

}  // namespace millforce::host
