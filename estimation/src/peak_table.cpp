// SPDX-License-Identifier: Apache-2.0
#include "estimation/cutting/peak_table_impl.hpp"

namespace millforce::estimation {

template class ToothPeakTable<float>;
template class ToothPeakTable<Fixed>;

}  // namespace millforce::estimation
