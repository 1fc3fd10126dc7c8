// SPDX-License-Identifier: Apache-2.0
#include "reproduce/reproduction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace millforce::sim {

bool Figure::holds() const {
    switch (judged) {
        case Judged::difference:
            return std::abs(ours - published) <= bound;
        case Judged::relative_difference:
            return std::abs(ours / published - 1.0) <= bound;
        case Judged::at_most:
            return ours <= bound;
        case Judged::at_least:
            return ours >= bound;
        case Judged::within:
            return ours >= bound_low && ours <= bound;
        case Judged::shown:
            return true;
    }
    return false;
}

std::string Figure::difference() const {
    if (!std::isfinite(published)) {
        return "";
    }
    const bool relative = judged == Judged::relative_difference || (judged == Judged::shown && published != 0.0);
    return relative ? fmt::format("{:+.1f} %", 100.0 * (ours / published - 1.0))
                    : fmt::format("{:+.3g}", ours - published);
}

std::string Figure::bound_text() const {
    switch (judged) {
        case Judged::difference:
            return fmt::format("± {:.3g}", bound);
        case Judged::relative_difference:
            return fmt::format("± {:.3g} %", 100.0 * bound);
        case Judged::at_most:
            return fmt::format("≤ {:.3g}", bound);
        case Judged::at_least:
            return fmt::format("≥ {:.3g}", bound);
        case Judged::within:
            return fmt::format("{:.3g}…{:.3g}", bound_low, bound);
        case Judged::shown:
            return "";
    }
    return "";
}

Figure own_check(std::string name, std::string unit, double value, Figure::Judged judged, double bound,
                 double bound_low) {
    return {std::move(name), std::move(unit), std::numeric_limits<double>::quiet_NaN(), value, judged,
            bound,           bound_low};
}

bool Reproduction::holds() const {
    const auto hold = [](const std::vector<Figure>& all) {
        return std::all_of(all.begin(), all.end(), [](const Figure& figure) { return figure.holds(); });
    };
    return hold(figures) && hold(checks);
}

}  // namespace millforce::sim
