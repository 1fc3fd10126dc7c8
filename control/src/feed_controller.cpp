// SPDX-License-Identifier: Apache-2.0
#include "control/feed_controller_impl.hpp"

namespace millforce::control {

template class FeedController<float>;
template class FeedController<estimation::Fixed>;

}  // namespace millforce::control
