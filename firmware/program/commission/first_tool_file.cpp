// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "commission/first_files.hpp"
#include "commission/tooth_force_advice.hpp"
#include "commission/workpieces.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

namespace {

struct ToolAnswers {
    ToothForceQuestion question{};
    double flute_length_mm = 0.0;
    double helix_deg = 0.0;
    std::string law_source;
};

/// 0.1 µm, 0.1 N: what lies beyond is not known.
double rounded(double value, double per_unit) {
    return std::round(value * per_unit) / per_unit;
}

/// By the maker's table. An answer that is missing leaves the law empty: it is reported before anyone uses it.
KnownLaw law_of_workpiece(Answers& answers) {
    const std::string name = answers.word({"tool.workpiece", "Workpiece", workpiece_names(), {}});
    KnownLaw known;
    if (!name.empty()) {
        const Workpiece& workpiece = workpiece_of(name);
        known.source = fmt::format("{}, ISCAR material groups; r_1: Kim & Chung, carbide in SM45C", workpiece.meaning);
        known.law.k_s_N_per_mm2 = workpiece.k_s_N_per_mm2;
        known.law.p_s = workpiece.p_s;
        known.law.k_1 = table_k_1;
        known.law.p_1 = table_p_1;
        known.law.K_s_relative_sd = table_K_s_relative_sd;
        known.law.r_1_relative_sd = table_r_1_relative_sd;
    }
    return known;
}

void use_law(ToolAnswers& tool, const KnownLaw& known) {
    tool.question.law = known.law;
    tool.law_source = known.source;
}

ToolAnswers ask_for_tool(Answers& answers, const std::optional<KnownLaw>& known) {
    ToolAnswers tool;
    ToothForceQuestion& q = tool.question;
    q.teeth = static_cast<int>(answers.integer({"tool.teeth", "Tool: number of teeth or inserts", "", 1.0, 12.0}));
    q.diameter_mm = answers.number({"tool.diameter_mm", "Tool: cutting diameter", "mm", 0.1, 1000.0});
    tool.flute_length_mm =
        answers.number({"tool.flute_length_mm", "Tool: length of its flutes or inserts", "mm", 0.1, 300.0});
    tool.helix_deg = answers.number({"tool.helix_deg", "Tool: helix angle, 0 for inserts", "°", 0.0, 60.0, 30.0});
    q.overhang_mm = answers.number({"tool.overhang_mm", "Tool: from the holder to the tip", "mm", 0.1, 1000.0});
    const double usual_depth_mm = std::min(q.diameter_mm, tool.flute_length_mm);
    q.deepest_cut_mm =
        answers.number({"tool.deepest_cut_mm", "Deepest cut that it is to make", "mm", 0.01, 300.0, usual_depth_mm});
    const bool is_carbide =
        answers.word({"tool.material", "Tool material", {"carbide", "hss"}, "carbide"}) == "carbide";
    q.strength_N_per_mm2 =
        answers.number({"tool.strength_N_per_mm2",
                        is_carbide ? "Transverse rupture strength of its carbide" : "Yield strength of its steel",
                        "N/mm²", 500.0, 1e4, is_carbide ? carbide_strength_N_per_mm2 : hss_strength_N_per_mm2});
    use_law(tool, known ? *known : law_of_workpiece(answers));
    q.largest_feed_per_tooth_mm = answers.number(
        {"control.max_feed_per_tooth_mm", "Largest feed per tooth by the tool's maker", "mm", 0.0005, 5.0});
    return tool;
}

void write_tool(FileDraft& draft, const ToolAnswers& tool, double limit_N, bool is_advised) {
    draft.set_integer("tool", "teeth", tool.question.teeth, "given");
    draft.set("tool", "diameter_mm", tool.question.diameter_mm, "given");
    draft.set("tool", "helix_deg", tool.helix_deg, "given");
    draft.set("tool", "flute_length_mm", tool.flute_length_mm, "given");
    draft.set("tool", "tooth_force_limit_N", limit_N,
              is_advised ? "advised: two thirds of what the core withstands, or the maker's feed" : "given");
}

void write_law(FileDraft& draft, const ToolAnswers& tool) {
    const auto& law = tool.question.law;
    draft.set("cutting", "k_s_N_per_mm2", law.k_s_N_per_mm2, tool.law_source);
    draft.set("cutting", "p_s", law.p_s);
    draft.set("cutting", "k_1", law.k_1);
    draft.set("cutting", "p_1", law.p_1);
    draft.set("cutting", "K_s_relative_sd", law.K_s_relative_sd);
    draft.set("cutting", "r_1_relative_sd", law.r_1_relative_sd);
}

/// Into what is not known yet: a slot of the deepest cut, in the hardest batch.
void write_control(FileDraft& draft, const ToolAnswers& tool, double limit_N) {
    const double entry_mm = entry_feed_per_tooth_mm(tool.question, limit_N);
    const double written_mm = std::max(rounded(entry_mm, 1e4), 5e-4);
    const std::string source = fmt::format("a slot {:.3g} mm deep stays below the limit", tool.question.deepest_cut_mm);
    draft.set("control", "entry_feed_per_tooth_mm", written_mm, source);
    draft.set("control", "air_feed_per_tooth_mm", written_mm, source);
    draft.set("control", "max_feed_per_tooth_mm", tool.question.largest_feed_per_tooth_mm, "given");
}

}  // namespace

FileDraft first_tool_file(Answers& answers, std::ostream& advice_out, const std::optional<KnownLaw>& known) {
    FileDraft draft(firmware::ParameterFile::tool);
    draft.set_heading("name", answers.word({"tool.name", "Name of the tool", {}, "tool"}));
    const ToolAnswers tool = ask_for_tool(answers, known);
    answers.require_all(false);
    draft.set_heading("description", fmt::format("Cutting law: {}", tool.law_source));
    if (tool.question.deepest_cut_mm >= 2.0 * tool.question.overhang_mm) {
        throw InputError(fmt::format("tool.overhang_mm = {:g}: expected more than half of tool.deepest_cut_mm = {:g}",
                                     tool.question.overhang_mm, tool.question.deepest_cut_mm));
    }
    const ToothForceAdvice advice = advise_tooth_force(tool.question);
    advice_out << "tooth_force_limit_N, the largest force that one tooth may carry:\n";
    for (const std::string& reason : advice.reasons) {
        advice_out << "  " << reason << '\n';
    }
    const double advised_N = rounded(advice.advised_N, advice.advised_N < 100.0 ? 10.0 : 1.0);
    const double limit_N = answers.number(
        {"tool.tooth_force_limit_N", "Largest force that one tooth may carry", "N", 0.1, 1e6, advised_N});
    write_tool(draft, tool, limit_N, limit_N == advised_N);
    write_law(draft, tool);
    write_control(draft, tool, limit_N);
    const bool is_watching =
        answers.word(
            {"control.monitor_only", "Leave the override to the operator, and watch", {"true", "false"}, "true"}) ==
        "true";
    draft.set_flag("control", "monitor_only", is_watching,
                   is_watching ? "until the estimates have been compared with real cuts" : "given");
    return draft;
}

}  // namespace millforce::host
