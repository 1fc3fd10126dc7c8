// SPDX-License-Identifier: Apache-2.0
#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

using namespace millforce::host;
using namespace millforce::test;

TEST_GROUP(AtomicFile){};

TEST(AtomicFile, appears_whole_on_commit_and_leaves_no_other_file) {
    const TemporaryFolder folder;
    folder.write("out.csv", "old");
    AtomicFile file(folder.path("out.csv"));
    file.stream() << "new " << std::string(200'000, 'x');
    STRCMP_EQUAL("old", folder.read("out.csv").c_str());
    file.commit();
    LONGS_EQUAL(200'004, folder.read("out.csv").size());
    LONGS_EQUAL(1, folder.file_count());
}

TEST(AtomicFile, without_commit_leaves_the_target_as_it_was) {
    const TemporaryFolder folder;
    folder.write("out.csv", "old");
    {
        AtomicFile file(folder.path("out.csv"));
        file.stream() << std::string(200'000, 'x');
    }
    STRCMP_EQUAL("old", folder.read("out.csv").c_str());
    LONGS_EQUAL(1, folder.file_count());
}

TEST(AtomicFile, names_a_target_that_cannot_be_written) {
    const TemporaryFolder folder;
    CHECK(contains(message_of<InputError>([&] { AtomicFile(folder.path("no/such/out.csv")); }), "No such file"));
    CHECK(contains(message_of<InputError>([&] { AtomicFile(folder.path("")); }), "is a folder"));
    CHECK(contains(message_of<InputError>([&] { AtomicFile("/dev/null"); }), "is a device"));
}

TEST(AtomicFile, reports_a_full_disk_and_keeps_the_target) {
    const TemporaryFolder folder;
    folder.write("out.csv", "old");
    AtomicFile file(folder.path("out.csv"));
    file.stream().setstate(std::ios::badbit);  // as after a failed write
    CHECK(contains(message_of<InputError>([&] { file.commit(); }), "cannot be written"));
    STRCMP_EQUAL("old", folder.read("out.csv").c_str());
    LONGS_EQUAL(1, folder.file_count());
}

TEST(AtomicFile, writes_through_a_symbolic_link) {
    const TemporaryFolder folder;
    folder.write("real.csv", "old");
    std::filesystem::create_symlink(folder.path("real.csv"), folder.path("link.csv"));
    AtomicFile file(folder.path("link.csv"));
    file.stream() << "new";
    file.commit();
    STRCMP_EQUAL("new", folder.read("real.csv").c_str());
    CHECK(std::filesystem::is_symlink(folder.path("link.csv")));
}

TEST(AtomicFile, leaves_nothing_behind_on_ctrl_c) {
    const TemporaryFolder folder;
    const pid_t child = ::fork();
    if (child == 0) {
        remove_unfinished_files_on_interrupt();
        AtomicFile file(folder.path("out.csv"));
        file.stream() << std::string(200'000, 'x');
        std::raise(SIGINT);
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    CHECK(WIFSIGNALED(status));
    LONGS_EQUAL(SIGINT, WTERMSIG(status));
    LONGS_EQUAL(0, folder.file_count());
}
