// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace millforce::estimation {

/// What a table holds a scalar as. Fixed point takes 64 bits for its range; in a table, whose entries are of one size,
/// the 32 bits of a float (relative resolution 6e-8) hold as much, and are read by shifts.
template <typename Scalar>
struct StoredAs {
    using Type = Scalar;
};

template <typename Scalar>
using Stored = typename StoredAs<Scalar>::Type;

}  // namespace millforce::estimation
