// SPDX-License-Identifier: Apache-2.0
// Instantiates the controller for float, so that the core's compiler flags and warnings see all of it.
#include "control/feed_controller.hpp"

namespace millforce::control {

template class FeedController<float>;

}  // namespace millforce::control
