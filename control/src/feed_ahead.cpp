// SPDX-License-Identifier: Apache-2.0
#include "control/feed_ahead_impl.hpp"

namespace millforce::control {

template class FeedAhead<float>;
template class FeedAhead<estimation::Fixed>;
template class FeedAhead<float, small_window>;
template class FeedAhead<estimation::Fixed, small_window>;

}  // namespace millforce::control
