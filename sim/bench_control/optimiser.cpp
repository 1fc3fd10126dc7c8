// SPDX-License-Identifier: Apache-2.0
#include "bench_control/optimiser.hpp"

#include <algorithm>
#include <cmath>

namespace millforce::sim {

namespace {

struct Vertex {
    std::vector<double> at;  ///< in shares of the ranges, 0…1
    double value = 0.0;
};

class Simplex {
  public:
    Simplex(const std::function<double(const std::vector<double>&)>& cost, const std::vector<SearchRange>& ranges)
        : cost_(cost), ranges_(ranges) {
        std::vector<double> start;
        start.reserve(ranges.size());
        for (const SearchRange& range : ranges) {
            start.push_back((range.start - range.low) / (range.high - range.low));
        }
        add(start);
        constexpr double edge = 0.2;
        for (std::size_t k = 0; k < ranges.size(); ++k) {
            std::vector<double> at = start;
            at[k] += at[k] + edge <= 1.0 ? edge : -edge;
            add(at);
        }
    }

    void improve() {
        std::ranges::stable_sort(vertices_, {}, &Vertex::value);
        Vertex& worst = vertices_.back();
        const double second_worst = vertices_[vertices_.size() - 2].value;
        const Vertex reflected = beyond(1.0);
        if (reflected.value < vertices_.front().value) {
            const Vertex expanded = beyond(2.0);
            worst = expanded.value < reflected.value ? expanded : reflected;
        } else if (reflected.value < second_worst) {
            worst = reflected;
        } else {
            const Vertex contracted = beyond(reflected.value < worst.value ? 0.5 : -0.5);
            if (contracted.value < std::min(reflected.value, worst.value)) {
                worst = contracted;
            } else {
                shrink();
            }
        }
    }

    [[nodiscard]] int evaluations() const { return evaluations_; }
    [[nodiscard]] double size() const {
        double largest = 0.0;
        for (const Vertex& vertex : vertices_) {
            for (std::size_t k = 0; k < ranges_.size(); ++k) {
                largest = std::max(largest, std::abs(vertex.at[k] - vertices_.front().at[k]));
            }
        }
        return largest;
    }
    [[nodiscard]] Minimum best() const {
        const Vertex& vertex = *std::ranges::min_element(vertices_, {}, &Vertex::value);
        return {in_ranges(vertex.at), vertex.value, evaluations_};
    }

  private:
    void add(const std::vector<double>& at) { vertices_.push_back(evaluated(at)); }

    [[nodiscard]] std::vector<double> in_ranges(const std::vector<double>& at) const {
        std::vector<double> values;
        for (std::size_t k = 0; k < ranges_.size(); ++k) {
            values.push_back(ranges_[k].low + at[k] * (ranges_[k].high - ranges_[k].low));
        }
        return values;
    }

    Vertex evaluated(std::vector<double> at) {
        for (double& share : at) {
            share = std::clamp(share, 0.0, 1.0);
        }
        ++evaluations_;
        const double value = cost_(in_ranges(at));
        return {std::move(at), value};
    }

    /// On the line from the worst vertex through the centre of the others, `factor` times their distance beyond it.
    Vertex beyond(double factor) {
        const Vertex& worst = vertices_.back();
        std::vector<double> at(ranges_.size());
        for (std::size_t k = 0; k < at.size(); ++k) {
            double centre = 0.0;
            for (std::size_t v = 0; v + 1 < vertices_.size(); ++v) {
                centre += vertices_[v].at[k] / static_cast<double>(vertices_.size() - 1);
            }
            at[k] = centre + factor * (centre - worst.at[k]);
        }
        return evaluated(std::move(at));
    }

    void shrink() {
        const std::vector<double> best = vertices_.front().at;
        for (std::size_t v = 1; v < vertices_.size(); ++v) {
            std::vector<double> at = vertices_[v].at;
            for (std::size_t k = 0; k < at.size(); ++k) {
                at[k] = 0.5 * (at[k] + best[k]);
            }
            vertices_[v] = evaluated(std::move(at));
        }
    }

    const std::function<double(const std::vector<double>&)>& cost_;
    const std::vector<SearchRange>& ranges_;
    std::vector<Vertex> vertices_;
    int evaluations_ = 0;
};

}  // namespace

Minimum minimise(const std::function<double(const std::vector<double>&)>& cost, const std::vector<SearchRange>& ranges,
                 int evaluations) {
    constexpr double smallest = 0.005;
    Simplex simplex(cost, ranges);
    while (simplex.evaluations() < evaluations && simplex.size() > smallest) {
        simplex.improve();
    }
    return simplex.best();
}

}  // namespace millforce::sim
