// SPDX-License-Identifier: Apache-2.0
#include "control/feed_ahead_impl.hpp"

namespace millforce::control {

template class FeedAhead<float>;
template class FeedAhead<estimation::Fixed>;

}  // namespace millforce::control
