// SPDX-License-Identifier: Apache-2.0
#include "bridge.hpp"
#include "inputs.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;

/// `millforce serve` with `--web`, `--udp-json` and `--mcap`, asked over real sockets while a CNC's bridge sends
/// samples.

namespace {

class Connection {
  public:
    explicit Connection(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        is_open_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    }
    ~Connection() { ::close(socket_); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    [[nodiscard]] bool is_open() const { return is_open_; }
    void send(const std::string& text) const { (void)::send(socket_, text.data(), text.size(), MSG_NOSIGNAL); }
    /// Reads until this is in it, to the end, or for half a minute.
    const std::string& read_until(const std::string& part) {
        std::array<char, 65536> bytes{};
        pollfd waiting{socket_, POLLIN, 0};
        while (text_.find(part) == std::string::npos && ::poll(&waiting, 1, 30'000) == 1) {
            const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
            if (count <= 0) {
                break;
            }
            text_.append(bytes.data(), static_cast<std::size_t>(count));
        }
        return text_;
    }

  private:
    int socket_;
    bool is_open_ = false;
    std::string text_{};
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_GROUP(ServeWatched) {
    Inputs inputs;
    std::unique_ptr<Program> serve;
    std::unique_ptr<Bridge> cnc;
    std::uint16_t port = 0;

    [[nodiscard]] std::vector<std::string> words(const std::string& option, const std::string& value) const {
        return {"serve",  inputs.name("a.sock"),    "--machine", inputs.name("machine.toml"),
                "--tool", inputs.name("tool.toml"), option,      value};
    }
    void start(const std::string& option = "--web", const std::string& value = "0") {
        serve = std::make_unique<Program>(words(option, value), inputs.name("error.txt"));
        cnc = std::make_unique<Bridge>(inputs.name("a.sock"));
        cnc->sample.spindle_current_A = 1.4F;
        cnc->sample.axis_current_A[0] = 2.3F;
        cnc->sample.axis_velocity_mm_s[0] = 20.0F;
        ask(300);
        const std::string error = inputs.read("error.txt");
        if (std::smatch found; std::regex_search(error, found, std::regex("http://127.0.0.1:([0-9]+)/"))) {
            port = static_cast<std::uint16_t>(std::stoul(found[1]));
        }
    }
    void ask(int samples) {
        for (int k = 0; k < samples; ++k) {
            cnc->ask();
        }
    }
    [[nodiscard]] std::string host() const {
        return "127.0.0.1:" + std::to_string(port);
    }
    [[nodiscard]] std::string answer(const std::string& request, const std::string& host_name,
                                     const std::string& more = {}) const {
        Connection connection(port);
        connection.send(request + " HTTP/1.1\r\nHost: " + host_name + "\r\nConnection: close\r\n" + more + "\r\n");
        return connection.read_until("nothing: to the end");
    }
    [[nodiscard]] std::string get(const std::string& path) const {
        return answer("GET " + path, host());
    }
    /// Until a tick was seen.
    [[nodiscard]] std::string telemetry() const {
        std::string text = get("/telemetry.json");
        while (contains(text, "no tick yet")) {
            text = get("/telemetry.json");
        }
        return text;
    }
    void end() {
        cnc.reset();
        serve->interrupt(SIGTERM);
        serve->wait();
        LONGS_EQUAL(0, serve->exit_code());
    }
};

TEST(ServeWatched, shows_page_and_telemetry_to_this_computer_alone) {
    start();
    CHECK(port != 0);
    CHECK(contains(telemetry(), R"("state":"air")"));
    const std::string page = get("/");
    CHECK(contains(page, "200 OK") && contains(page, "live.js"));
    CHECK(contains(page, "Content-Security-Policy: default-src 'none'"));
    CHECK(!contains(page, "Access-Control"));
    for (const char* path : {"/live.js", "/live.css", "/dygraph.js", "/dygraph.css", "/fields.json", "/metrics"}) {
        CHECK_TEXT(contains(get(path), "200 OK"), path);
    }
    for (const char* stranger : {"attacker.example", "attacker.example:80", "127.0.0.1", "192.168.0.1:80", ""}) {
        CHECK_TEXT(contains(answer("GET /telemetry.json", stranger), " 40"), stranger);
        CHECK_TEXT(!contains(answer("GET /telemetry.json", stranger), "override"), stranger);
    }
    CHECK(contains(answer("GET /telemetry.json", "localhost:" + std::to_string(port)), "200 OK"));
    CHECK(contains(answer("POST /telemetry.json", host(), "Content-Length: 3\r\n"), " 405 "));
    CHECK(contains(get("/../../etc/passwd"), " 404 "));
    CHECK(contains(answer("GET /events", host(), "Sec-Fetch-Site: cross-site\r\n"), " 403 "));
    end();
}

TEST(ServeWatched, gives_prometheus_each_metric_with_its_type_and_one_value) {
    start();
    (void)telemetry();
    const std::string text = get("/metrics");
    std::istringstream lines(text.substr(text.find("\r\n\r\n") + 4));
    const std::regex comment("# (HELP|TYPE) ([a-z_]+) (.+)");
    const std::regex sample(R"(([a-z_]+)(\{[a-z_]+="[a-z_]+"\})? (-?[0-9.]+(e[-+]?[0-9]+)?))");
    std::set<std::string> typed;
    std::set<std::string> samples;
    std::smatch found;
    for (std::string line; std::getline(lines, line);) {
        if (std::regex_match(line, found, comment)) {
            CHECK_TEXT(found[1] != "TYPE" || typed.insert(found[2]).second, line.c_str());
        } else {
            CHECK_TEXT(std::regex_match(line, found, sample), line.c_str());
            CHECK_TEXT(typed.contains(found[1]), line.c_str());
            CHECK_TEXT(samples.insert(found[1].str() + found[2].str()).second, line.c_str());
        }
    }
    for (const char* line : {"\nmillforce_state{state=\"air\"} 1\n", "\nmillforce_state{state=\"in_cut\"} 0\n",
                             "\nmillforce_x_velocity_meters_per_second 0.02\n",
                             "\nmillforce_operator_override_ratio 0.75\n", "\n# TYPE millforce_ticks_total counter\n",
                             "\nmillforce_spindle_current_amperes 1.4\n", "\nmillforce_ticks_total 300\n"}) {
        CHECK_TEXT(contains(text, line), line);
    }
    CHECK(!contains(text, "\nmillforce_radial_immersion_ratio "));
    end();
}

TEST(ServeWatched, streams_what_was_and_what_comes) {
    start();
    Connection page(port);
    page.send("GET /events HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
    CHECK(contains(page.read_until("run begins"), "text/event-stream"));
    ask(500);
    cnc->ask(200'000);  // a gap in the samples
    CHECK(contains(page.read_until("fault: stale_input"), "event: rows\ndata: [[1"));
    end();
}

TEST(ServeWatched, answers_the_cnc_whatever_its_clients_do) {
    start();
    std::vector<std::unique_ptr<Connection>> clients;
    for (int k = 0; k < 34; ++k) {  // two more than it takes, with requests that never end
        clients.push_back(std::make_unique<Connection>(port));
        clients.back()->send("GET /events HTTP/1.1\r\nHost: " + host() + (k % 2 == 0 ? "\r\nA: " : "\r\n\r\n"));
    }
    clients.front()->send(std::string(1'000'000, 'A'));
    ask(1000);
    clients.clear();
    CHECK(contains(telemetry(), "200 OK"));
    UNSIGNED_LONGS_EQUAL(1301, cnc->ask().heartbeat);
    end();
}

TEST(ServeWatched, refuses_a_port_that_is_used_or_none) {
    start();
    const std::string used = std::to_string(port);
    inputs.write("b.txt", "");
    auto second = words("--web", used);
    second[1] = inputs.name("b.sock");
    const Ended ended = run_millforce(second);
    LONGS_EQUAL(2, ended.exit_code);
    CHECK(contains(ended.error, "--web: port " + used + " of 127.0.0.1: Address already in use"));
    second[7] = "65536";
    CHECK(contains(run_millforce(second).error, "--web: 65536, expected a port from 0 to 65535"));
    end();
}

TEST(ServeWatched, sends_each_tick_as_json_by_udp) {
    const int receiver = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::bind(receiver, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    socklen_t length = sizeof address;
    ::getsockname(receiver, reinterpret_cast<sockaddr*>(&address), &length);
    start("--udp-json", "127.0.0.1:" + std::to_string(ntohs(address.sin_port)));
    for (int tick = 1; tick <= 100; ++tick) {
        std::array<char, 4096> bytes{};
        const ssize_t count = ::recv(receiver, bytes.data(), bytes.size(), 0);
        const std::string text(bytes.data(), static_cast<std::size_t>(count > 0 ? count : 0));
        CHECK(text.starts_with("{\"timestamp\":1") && text.ends_with("}}"));
        CHECK(contains(text, ",\"millforce\":{\"time_s\":"));
        CHECK(contains(text, "\"ticks\":" + std::to_string(tick) + ","));
        CHECK(count < 1400);  // one packet of a network
    }
    ::close(receiver);
    end();
}

TEST(ServeWatched, refuses_an_address_that_is_no_host_and_port) {
    for (const char* address : {"9870", "127.0.0.1", "127.0.0.1:", ":9870", "127.0.0.1:0", "127.0.0.1:70000",
                                "::1:9870", "[]:9870", "127.0.0.1:x"}) {
        const Ended ended = run_millforce(words("--udp-json", address));
        LONGS_EQUAL_TEXT(2, ended.exit_code, address);
        CHECK_TEXT(contains(ended.error, "--udp-json"), address);
    }
}

TEST(ServeWatched, writes_an_mcap_file_that_is_whole_at_the_end) {
    start("--mcap", inputs.name("run.mcap"));
    ask(300);
    end();
    const std::string file = inputs.read("run.mcap");
    const std::string magic("\x89MCAP0\r\n", 8);
    CHECK(file.starts_with(magic) && file.ends_with(magic) && file.size() > 1000);
    CHECK(contains(file, R"("ticks":1,)") && contains(file, R"("message":"run begins")"));
}

TEST(ServeWatched, ends_with_code_1_where_a_disk_did_not_take_its_mcap_file) {
    start("--mcap", "/dev/full");
    cnc.reset();
    serve->interrupt(SIGTERM);
    serve->wait();
    LONGS_EQUAL(1, serve->exit_code());
    CHECK(contains(inputs.read("error.txt"), "/dev/full: could not be written: the file ends here"));
}
