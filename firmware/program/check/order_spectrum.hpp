// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace millforce::host {

/// Power of a signal at multiples of an eighth of the spindle's order (1 order: once per revolution), from blocks of
/// eight recorded revolutions. The straight line through a block is taken off it, and a Hann window keeps a change
/// within it out of the neighbouring orders. The samples need not be even in the angle.
struct OrderBlock {
    static constexpr int per_order = 8;  ///< also the revolutions of a block

    double start_s = 0.0;
    double end_s = 0.0;
    double samples_per_rev = 0.0;
    std::vector<double> power;  ///< at order k/8, from k = 0 up to the highest order and half an order beyond
};

/// Cuts a signal into blocks, sample by sample. Memory: the samples of one block.
class OrderBlocks {
  public:
    /// A gap in the angle of half a revolution, or a step backwards, begins a new block.
    void add(double time_s, double turned_rev, double value);
    [[nodiscard]] const std::vector<OrderBlock>& blocks() const { return blocks_; }

  private:
    struct Sample {
        double time_s;
        double angle_rev;
        double value;
    };
    void close();

    std::vector<Sample> samples_;
    std::vector<OrderBlock> blocks_;
};

/// The mean over blocks, and what stands out of its surroundings.
class OrderSpectrum {
  public:
    void add(const OrderBlock& block);

    [[nodiscard]] std::size_t blocks() const { return blocks_; }
    /// The highest whole order of all blocks: a period of it has 2.5 samples or more.
    [[nodiscard]] int highest_order() const;
    [[nodiscard]] double power(std::size_t place) const;
    /// Power at order place/8 beyond the median of its surroundings; 0 where it does not stand out. The power of noise
    /// in n blocks has the relative deviation 1/√n: twice four of them are asked for, since there are many orders.
    [[nodiscard]] double line(std::size_t place) const;

    static constexpr std::size_t fewest_blocks = 8;

  private:
    [[nodiscard]] double surroundings(std::size_t place) const;

    std::size_t blocks_ = 0;
    std::vector<double> sum_;
};

}  // namespace millforce::host
