#include "firmware/tick.hpp"

#include "firmware/parameter_table.hpp"

namespace millforce::firmware {

template class ForceControlTick<float>;

}  // namespace millforce::firmware
