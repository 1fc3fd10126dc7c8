// SPDX-License-Identifier: Apache-2.0
#include "control/feed_law_impl.hpp"

namespace millforce::control {

template class FeedLaw<float>;
template class FeedLaw<estimation::Fixed>;

}  // namespace millforce::control
