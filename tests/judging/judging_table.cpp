// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "judging/judge.hpp"
#include "parameters/parameter_files.hpp"
#include "percent.hpp"

/// Prints how the estimates of many drawn cuts hold against the truth: judging_table [CUTS] [FIRST_SEED] [WRONG]. WRONG
/// is a name of the table's first column, or a part of one: only those. The second table is of those in which the law
/// is right, by kinds of cuts.

namespace {

using namespace millforce;
using namespace millforce::judging;
using millforce::test::percent;

struct CutKind {
    const char* name;
    bool (*holds)(const DrawnCut& drawn);
};

template <int tenths_low, int tenths_high>
bool has_immersion_between(const DrawnCut& drawn) {
    return 10.0 * drawn.cut.radial_immersion >= tenths_low && 10.0 * drawn.cut.radial_immersion < tenths_high;
}

bool moves_one_axis(const DrawnCut& drawn) {
    constexpr double rests = 1e-6;
    return std::abs(std::sin(2.0 * drawn.direction_rad)) < rests;
}

constexpr std::array kinds{
    CutKind{"down milling", [](const DrawnCut& drawn) { return !drawn.cut.is_up; }},
    CutKind{"up milling", [](const DrawnCut& drawn) { return drawn.cut.is_up; }},
    CutKind{"R_r 0.1 to 0.5", has_immersion_between<1, 5>},
    CutKind{"R_r 0.5 to 1", has_immersion_between<5, 10>},
    CutKind{"R_r 1 to 1.5", has_immersion_between<10, 15>},
    CutKind{"R_r 1.5 to 2", has_immersion_between<15, 21>},
    CutKind{"one axis moves", moves_one_axis},
    CutKind{"both axes move", [](const DrawnCut& drawn) { return !moves_one_axis(drawn); }},
};

struct Judged {
    Tally all;
    std::array<Tally, kinds.size()> of_kind;
};

Judged judged(const firmware::Parameters<float>& files, Wrong wrong, int cuts, std::uint64_t first_seed) {
    Judged judged;
    for (int i = 0; i < cuts; ++i) {
        const DrawnCut drawn = draw_cut(files, wrong, first_seed + static_cast<std::uint64_t>(i));
        const Verdict verdict = judge(drawn);
        judged.all.add(verdict);
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            if (kinds[k].holds(drawn)) {
                judged.of_kind[k].add(verdict);
            }
        }
    }
    return judged;
}

bool law_is_right(Wrong wrong) {
    return wrong == Wrong::nothing || wrong == Wrong::nothing_stated || wrong == Wrong::side;
}

void print(const char* kind, Wrong wrong, const Tally& t) {
    fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", kind, name_of(wrong), t.cuts,
               percent(t.cuts_with_immersion, t.cuts), percent(t.immersions_cover, t.cuts_with_immersion),
               percent(t.immersions_beyond, t.immersions), percent(t.cuts_with_depth, t.cuts),
               percent(t.depths_cover, t.cuts_with_depth), percent(t.depths_beyond, t.depths));
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
    std::vector<Judged> results(wrongs.size());
    const auto work = [&](std::size_t first) {
        for (std::size_t i = first; i < wrongs.size(); i += 2) {
            results[i] = judged(files, wrongs[i], cuts, first_seed);
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
        print(wrongs[i], results[i].all);
    }
    fmt::print(
        "\n| kind of cut | wrong | cuts | R_r, % of cuts | covered | beyond 3 sd | a_p, % of cuts | covered | beyond 3 "
        "sd |\n|---|---|---|---|---|---|---|---|---|\n");
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        for (std::size_t i = 0; i < wrongs.size(); ++i) {
            if (law_is_right(wrongs[i])) {
                print(kinds[k].name, wrongs[i], results[i].of_kind[k]);
            }
        }
    }
}
