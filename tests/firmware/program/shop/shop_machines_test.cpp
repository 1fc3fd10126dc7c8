// SPDX-License-Identifier: Apache-2.0
#include "shop/shop_machines.hpp"

#include <fmt/format.h>

#include <string>

#include <CppUTest/TestHarness.h>

using millforce::host::JsonWriter;
using millforce::host::ShopMachines;

TEST_GROUP(ShopMachines) {
    ShopMachines shop{};

    [[nodiscard]] std::string json() const {
        JsonWriter writer;
        writer.begin_object();
        shop.write(writer);
        return writer.end_object().str();
    }
    [[nodiscard]] bool has(const std::string& part) const {
        return json().find(part) != std::string::npos;
    }
};

TEST(ShopMachines, know_who_is_there_and_their_newest_state) {
    shop.take("vmc1/online", "1");
    shop.take("vmc2/online", "1");
    shop.take("vmc1/state", "{\"override\":0.5}");
    shop.take("vmc1/state", "{\"override\":0.7}");
    shop.take("vmc2/online", "0");
    STRCMP_EQUAL(
        "{\"machines\":[{\"name\":\"vmc1\",\"is_online\":true,\"state\":\"{\\\"override\\\":0.7}\",\"events\":[],"
        "\"jobs\":[]},{\"name\":\"vmc2\",\"is_online\":false,\"state\":\"\",\"events\":[],\"jobs\":[]}]}",
        json().c_str());
}

TEST(ShopMachines, keep_the_last_events_and_jobs_the_newest_first) {
    for (std::size_t k = 0; k < ShopMachines::most_notes + 2; ++k) {
        shop.take("vmc1/event", fmt::format("event {}.", k));
        shop.take("vmc1/job", fmt::format("job {}.", k));
    }
    CHECK(has("\"events\":[\"event 11.\",\"event 10.\""));
    CHECK(has("\"jobs\":[\"job 11.\",\"job 10.\""));
    CHECK(has("event 2."));
    CHECK_FALSE(has("event 1.\""));
}

TEST(ShopMachines, leave_out_what_no_gateway_sends) {
    for (const char* levels : {"", "vmc1", "/state", "vmc1/tools/T1.toml", "all/state", "a b/state", "../state",
                               "vmc1/other", "<b>/online"}) {
        shop.take(levels, "1");
    }
    shop.take("vmc1/state", std::string(ShopMachines::most_bytes + 1, 'x'));
    STRCMP_EQUAL("{\"machines\":[]}", json().c_str());
}

TEST(ShopMachines, write_text_that_is_fit_for_a_page_whatever_they_were_told) {
    shop.take("vmc1/state", std::string("</script>\0\xFF\"", 12));
    CHECK(has("\\u003c/script\\u003e\\u0000"));
}

TEST(ShopMachines, are_not_more_than_memory_is_for) {
    for (std::size_t k = 0; k < ShopMachines::most_machines; ++k) {
        shop.take(fmt::format("m{}/online", k), "1");
    }
    shop.take("one_more/online", "1");
    CHECK_FALSE(has("one_more"));
    shop.take("m7/online", "0");
    CHECK(has("{\"name\":\"m7\",\"is_online\":false"));
}
