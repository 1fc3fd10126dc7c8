// SPDX-License-Identifier: Apache-2.0
#include "inputs.hpp"

#include <sys/socket.h>
#include <sys/un.h>

#include <array>
#include <cstring>
#include <functional>
#include <thread>

#include <CppUTest/TestHarness.h>

using namespace millforce::test;

/// `millforce simulate --controller socket:PATH` with controllers of all kinds behind the socket.

namespace {

/// A controller that listens at a path. Each of its lines is worked out by the number of the line that it answers, 0
/// for hello; an empty one ends the connection, "silence" waits until the other side gives up.
class Controller {
  public:
    using Answers = std::function<std::string(int line)>;

    Controller(const std::string& path, Answers answers) : answers_(std::move(answers)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
        listener_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
            ::listen(listener_, 1) != 0) {
            throw std::runtime_error("no socket at " + path);
        }
        thread_ = std::thread([this] { play(); });
    }
    ~Controller() {
        ::shutdown(listener_, SHUT_RDWR);
        join();
        ::close(listener_);
    }
    Controller(const Controller&) = delete;
    Controller& operator=(const Controller&) = delete;

    /// The last line that it got.
    const std::string& last() {
        join();
        return last_;
    }

  private:
    void join() {
        if (thread_.joinable()) {
            thread_.join();
        }
    }
    void play() {
        peer_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        for (int line = 0; peer_ >= 0 && read_line(); ++line) {
            if (last_.find("\"type\":\"end\"") != std::string::npos) {
                break;
            }
            const std::string answer = answers_(line);
            if (answer.empty()) {
                break;
            }
            if (answer != "silence") {
                ::send(peer_, answer.data(), answer.size(), MSG_NOSIGNAL);
            }
        }
        ::close(peer_);
    }
    bool read_line() {
        std::size_t end = 0;
        while ((end = received_.find('\n')) == std::string::npos) {
            std::array<char, 4096> bytes{};
            const ssize_t count = ::recv(peer_, bytes.data(), bytes.size(), 0);
            if (count <= 0) {
                return false;
            }
            received_.append(bytes.data(), static_cast<std::size_t>(count));
        }
        last_ = received_.substr(0, end);
        received_.erase(0, end + 1);
        return true;
    }

    Answers answers_;
    int listener_ = -1;
    int peer_ = -1;
    std::string received_;
    std::string last_;
    std::thread thread_;
};

const std::string ready = "{\"type\": \"ready\", \"version\": 1, \"name\": \"a <b> of mine\"}\n";

}  // namespace

TEST_GROUP(SocketController) {
    Inputs inputs;

    Ended simulate(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"simulate",     inputs.name("scenario.toml"),
                                       "--controller", "socket:" + inputs.name("a.sock"),
                                       "--out",        inputs.name("results")};
        words.insert(words.end(), more.begin(), more.end());
        return run_millforce(words);
    }
    /// "" where the run was refused for this reason, the controller was told so, and no result was written.
    std::string not_refused_with(const Controller::Answers& answers, const std::string& reason) const {
        std::filesystem::remove(inputs.path("a.sock"));
        Controller controller(inputs.name("a.sock"), answers);
        std::string wrong = not_refused(simulate({"--controller-timeout", "1"}), {"a.sock: " + reason});
        wrong += std::filesystem::exists(inputs.path("results/summary.json")) ? "wrote results" : "";
        return wrong;
    }
};

TEST(SocketController, plays_against_the_plant_and_is_named_in_table_and_report) {
    std::string first_trace;
    for (int run = 0; run < 2; ++run) {
        std::filesystem::remove(inputs.path("a.sock"));
        Controller controller(inputs.name("a.sock"), [](int line) {
            const double ratio = line % 2000 < 1000 ? 0.75 : 1.0;
            return line == 0 ? ready : fmt::format("{{\"sample\": {}, \"override\": {}}}\n", line, ratio);
        });
        const Ended ended = simulate({"--record"});
        CHECK(ended.exit_code <= 1);
        STRCMP_CONTAINS("a <b> of mine", ended.out.c_str());
        STRCMP_CONTAINS("\"finished\":true", controller.last().c_str());
        const std::string trace = inputs.read("results/trace.csv");
        STRCMP_CONTAINS(",0.75,a <b> of mine,", trace.c_str());
        CHECK(first_trace.empty() || trace == first_trace);
        first_trace = trace;
    }
    STRCMP_CONTAINS("a \\u003cb\\u003e of mine", inputs.read("results/report.html").c_str());
    STRCMP_CONTAINS(",0.75,", inputs.read("results/recording.csv").c_str());
}

TEST(SocketController, what_goes_wrong_ends_the_run_with_one_line_that_says_what) {
    const auto at_line = [](int place, const std::string& bytes) {
        return [place, bytes](int line) {
            return line == place ? bytes : line == 0 ? ready : std::string("{\"override\": 1}\n");
        };
    };
    const struct {
        Controller::Answers answers;
        const char* reason;
    } cases[]{
        {at_line(0, ""), "the controller closed the connection before the answer to hello"},
        {at_line(0, "{\"override\": 1}\n"), "the answer to hello: no key type"},
        {at_line(0, "silence"), "the answer to hello did not come within 1 s"},
        {at_line(300, ""), "the controller closed the connection before the answer to sample 300"},
        {at_line(300, "silence"), "the answer to sample 300 did not come within 1 s"},
        {at_line(300, "{\"override\": 1"), "the answer to sample 300 did not come within 1 s"},
        {at_line(300, "{\"override\": 9}\n"),
         "the answer to sample 300: override is 9, expected a number from 0.1 to 1.5"},
        {at_line(300, "{\"override\": 1}\n{\"override\": 1}\n"),
         "the controller sent more than one line before sample 301"},
        {at_line(300, std::string(200000, '[')), "the answer to sample 300 is longer than 4096 bytes"},
        {at_line(300, "\x1b[2J\n"), "the answer to sample 300: '?[2J', expected a JSON object in one line"},
    };
    for (const auto& [answers, reason] : cases) {
        STRCMP_EQUAL("", not_refused_with(answers, reason).c_str());
    }
}

TEST(SocketController, is_told_what_was_wrong_with_its_answer) {
    Controller controller(inputs.name("a.sock"), [](int line) {
        return line == 0 ? ready : line == 1 ? "{\"override\": true}\n" : "";
    });
    LONGS_EQUAL(2, simulate().exit_code);
    STRCMP_CONTAINS("{\"type\":\"error\",\"message\":\"the answer to sample 1: override is true",
                    controller.last().c_str());
}

TEST(SocketController, who_holds_the_feed_for_ever_does_not_hold_the_program) {
    Controller controller(inputs.name("a.sock"), [](int line) {
        return line == 0 ? ready : std::string("{\"override\": 1, \"hold\": true}\n");
    });
    STRCMP_EQUAL("", not_refused(simulate(), {"the feed has been held for 10 s"}).c_str());
}

TEST(SocketController, without_a_controller_the_run_is_refused_in_time) {
    STRCMP_EQUAL("", not_refused(simulate({"--controller-timeout", "0.1"}),
                                 {"a.sock: no controller listens there within 0.1 s: No such file"})
                         .c_str());
    inputs.write("a.sock", "a file");
    STRCMP_EQUAL("", not_refused(simulate({"--controller-timeout", "0.1"}), {"a.sock: no controller"}).c_str());
    STRCMP_EQUAL("", not_refused(run_millforce({"simulate", inputs.name("scenario.toml"), "--controller",
                                                "socket:" + std::string(200, 'a')}),
                                 {"expected the path of a socket"})
                         .c_str());
}
