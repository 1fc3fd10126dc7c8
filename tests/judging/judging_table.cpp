// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "judging/judge.hpp"
#include "parameters/parameter_files.hpp"
#include "percent.hpp"

/// Prints how the estimates of many drawn cuts hold against the truth: judging_table [CUTS] [FIRST_SEED] [WRONG]. WRONG
/// is a name of the table's first column, or a part of one: only those.

namespace {

using namespace millforce;
using namespace millforce::judging;
using millforce::test::percent;

Tally tally_of(const firmware::Parameters<float>& files, Wrong wrong, int cuts, std::uint64_t first_seed) {
    Tally tally;
    for (int i = 0; i < cuts; ++i) {
        tally.add(judge(draw_cut(files, wrong, first_seed + static_cast<std::uint64_t>(i))));
    }
    return tally;
}

void print(Wrong wrong, const Tally& t) {
    fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} ({:.2f}) | {} | {} |\n", name_of(wrong),
               percent(t.cuts_with_immersion, t.cuts), percent(t.immersions_cover, t.cuts_with_immersion),
               percent(t.immersions_beyond, t.immersions), percent(t.beyond_with_twin, t.immersions_beyond),
               percent(t.cuts_with_depth, t.cuts), percent(t.depths_cover, t.cuts_with_depth),
               percent(t.depths_beyond, t.depths), t.depths_beyond_flute, percent(t.cuts_too_fast, t.cuts),
               t.largest_excess, percent(t.too_fast_with_twin, t.cuts_too_fast), percent(t.faults, t.cuts));
}

}  // namespace

int main(int argc, char** argv) {
    const int cuts = argc > 1 ? std::max(1, std::atoi(argv[1])) : 200;
    const auto first_seed = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 1);
    const std::string only = argc > 3 ? argv[3] : "";
    std::vector<Wrong> wrongs;
    std::ranges::copy_if(all_wrongs, std::back_inserter(wrongs),
                         [&only](Wrong wrong) { return std::string(name_of(wrong)).find(only) != std::string::npos; });
    const std::string scenarios = std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/";
    const auto files = host::read_parameters(scenarios + "machines/vmc.toml", scenarios + "tools/endmill_10mm.toml");
    std::vector<Tally> tallies(wrongs.size());
    const auto work = [&](std::size_t first) {
        for (std::size_t i = first; i < wrongs.size(); i += 2) {
            tallies[i] = tally_of(files, wrongs[i], cuts, first_seed);
        }
    };
    std::thread other(work, 1);
    work(0);
    other.join();
    fmt::print(
        "| wrong | R_r, % of cuts | covered | beyond 3 sd | of these with a twin | a_p, % of cuts | covered | beyond 3 "
        "sd "
        "| beyond the "
        "flute | too fast, % of cuts (worst) | of these with a twin | faults, % "
        "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (std::size_t i = 0; i < wrongs.size(); ++i) {
        print(wrongs[i], tallies[i]);
    }
}
