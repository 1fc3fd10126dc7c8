# SPDX-License-Identifier: Apache-2.0
# The pace of QEMU's ZCU102 under run-on-zcu102: of its nanoseconds, one for each instruction of any processor, so many are
# taken for a microsecond by the programs of both. 2000: half a nanosecond an instruction (firmware/README.md).
set(MILLFORCE_EMULATED_NS_PER_US 2000)
