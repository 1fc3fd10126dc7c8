// SPDX-License-Identifier: Apache-2.0
#include "firmware/core_in_one_file.hpp"
