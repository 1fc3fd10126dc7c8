// SPDX-License-Identifier: Apache-2.0
#include "calibration/coefficient_library.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::host;
using namespace millforce::test;

namespace {

std::string entry_named(const std::string& name, const char* k_s) {
    return "[[coefficients]]\nname = \"" + name + "\"\nk_s_N_per_mm2 = " + k_s + "\nk_1 = 0.3\n";
}

}  // namespace

TEST_GROUP(CoefficientLibrary) {
    TemporaryFolder folder;

    double k_s_of(const std::string& text, const std::string& name) {
        return static_cast<double>(library_entry(folder.write("lib.toml", text), name).law.k_s_N_per_mm2);
    }
    std::string error_of(const std::string& text, const std::string& name) {
        return message_of<InputError>([&] { k_s_of(text, name); });
    }
};

TEST(CoefficientLibrary, gives_the_entry_of_a_name_or_the_only_one) {
    DOUBLES_EQUAL(700.0, k_s_of(entry_named("aluminium", "700"), ""), 0.0);
    const std::string both = entry_named("aluminium", "700") + entry_named("steel", "1700");
    DOUBLES_EQUAL(1700.0, k_s_of(both, "steel"), 0.0);
}

TEST(CoefficientLibrary, names_the_entries_where_the_one_asked_for_is_not_clear) {
    const std::string both = entry_named("aluminium", "700") + entry_named("steel", "1700");
    STRCMP_CONTAINS("lib.toml: 2 entries; expected --entry with one of aluminium, steel", error_of(both, "").c_str());
    STRCMP_CONTAINS("lib.toml: no entry 'brass'; expected one of aluminium, steel", error_of(both, "brass").c_str());
    STRCMP_CONTAINS("twice in the file, expected another name",
                    error_of(entry_named("steel", "700") + entry_named("steel", "800"), "steel").c_str());
    STRCMP_CONTAINS("lib.toml: no [[coefficients]] table", error_of("", "").c_str());
}
