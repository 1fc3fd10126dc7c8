// SPDX-License-Identifier: Apache-2.0
#include "daemon/log_file.hpp"

#include <sys/resource.h>

#include <cerrno>
#include <csignal>
#include <string>

#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::host;

namespace {

const std::string missing = "# {} lines are missing\n";

/// Files of this process may have so many bytes.
class SizeLimit {
  public:
    explicit SizeLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~SizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
    SizeLimit(const SizeLimit&) = delete;
    SizeLimit& operator=(const SizeLimit&) = delete;

  private:
    rlimit before_{};
};

}  // namespace

TEST_GROUP(LogFile) {
    millforce::test::TemporaryFolder folder;

    std::string name() const {
        return folder.path("log").string();
    }
    std::string text() const {
        return folder.read("log");
    }
};

TEST(LogFile, ends_with_a_whole_line_where_no_more_fits_and_says_later_what_is_missing) {
    LogFile file(name(), missing);
    {
        const SizeLimit limit(10);
        file.add("12345\n");
        file.add("67890\n");
        LONGS_EQUAL(EFBIG, file.flush());
        STRCMP_EQUAL("12345\n", text().c_str());
        file.add("abcde\n");
        LONGS_EQUAL(EFBIG, file.flush());
        STRCMP_EQUAL("12345\n", text().c_str());
    }
    file.add("again\n");
    LONGS_EQUAL(0, file.flush());
    file.add("and again\n");
    LONGS_EQUAL(0, file.flush());
    STRCMP_EQUAL("12345\n# 2 lines are missing\nagain\nand again\n", text().c_str());
    UNSIGNED_LONGS_EQUAL(2, file.failures());
}

TEST(LogFile, goes_on_in_a_new_file_after_a_rename_and_at_the_begin_of_an_emptied_one) {
    LogFile file(name(), missing);
    file.add("one\n");
    file.flush();
    std::filesystem::rename(name(), name() + ".1");
    file.add("two\n");
    file.flush();
    LONGS_EQUAL(0, file.reopen());
    file.add("three\n");
    file.flush();
    STRCMP_EQUAL("one\ntwo\n", folder.read("log.1").c_str());
    STRCMP_EQUAL("three\n", text().c_str());
    LONGS_EQUAL(0, file.reopen());  // nobody has renamed it
    std::filesystem::resize_file(name(), 0);
    file.add("four\n");
    file.flush();
    STRCMP_EQUAL("four\n", text().c_str());
}

TEST(LogFile, keeps_the_old_file_where_the_new_one_cannot_be_made) {
    LogFile file(name(), missing);
    std::filesystem::rename(name(), name() + ".1");
    std::filesystem::create_directory(name());
    LONGS_EQUAL(EISDIR, file.reopen());
    file.add("one\n");
    LONGS_EQUAL(0, file.flush());
    STRCMP_EQUAL("one\n", folder.read("log.1").c_str());
}

TEST(LogFile, is_written_by_one_at_a_time) {
    {
        LogFile file(name(), missing);
        file.add("one\n");
        file.flush();
        CHECK(millforce::test::contains(millforce::test::message_of<InputError>([&] { LogFile(name(), missing); }),
                                        "is being written by a running program"));
        STRCMP_EQUAL("one\n", text().c_str());
    }
    LogFile next(name(), missing);
    STRCMP_EQUAL("", text().c_str());
}
