// SPDX-License-Identifier: Apache-2.0
#include "daemon/unix_socket.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <memory>
#include <span>
#include <string>

#include <CppUTest/TestHarness.h>

using namespace millforce::host;
using namespace millforce::test;

namespace {

/// A program at the other end.
class Client {
  public:
    explicit Client(const std::string& path) : descriptor_(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
        CHECK_EQUAL(0, connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address));
    }
    ~Client() { close(descriptor_); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    void send(const std::string& text) const {
        CHECK_EQUAL(static_cast<ssize_t>(text.size()), ::send(descriptor_, text.data(), text.size(), MSG_NOSIGNAL));
    }
    /// Empty: the server has closed it.
    std::string receive() const {
        std::array<char, 64> text{};
        const ssize_t length = recv(descriptor_, text.data(), text.size(), 0);
        return {text.data(), static_cast<std::size_t>(length > 0 ? length : 0)};
    }

  private:
    int descriptor_;
};

/// Lets the peer send once the server has waited twice.
class AfterTwoTurns final : public TurnListener {
  public:
    void begin(const Client& client) {
        client_ = &client;
        turns_ = 0;
    }
    void on_turn() override {
        if (++turns_ == 2 && client_ != nullptr) {
            client_->send("late");
        }
    }

  private:
    const Client* client_ = nullptr;
    int turns_ = 0;
};

std::string text_of(std::span<const std::uint8_t> bytes) {
    return {bytes.begin(), bytes.end()};
}

std::string refusal_of(const std::string& path) {
    return message_of<InputError>([&] { UnixServer server(path); });
}

constexpr std::array<std::uint8_t, 2> answer{'o', 'k'};

}  // namespace

TEST_GROUP(UnixServer) {
    TemporaryFolder folder;
    std::string path = folder.path("s").string();
};

TEST(UnixServer, serves_whole_messages_of_one_peer_after_the_other) {
    UnixServer server(path);
    for (const char* name : {"first", "second"}) {
        auto client = std::make_unique<Client>(path);
        CHECK(server.wait_for_peer());
        client->send(name);
        STRCMP_EQUAL(name, text_of(server.receive()).c_str());
        server.send(answer);
        STRCMP_EQUAL("ok", client->receive().c_str());
        client.reset();
        CHECK(server.receive().empty());
        CHECK_FALSE(server.has_peer());
    }
}

TEST(UnixServer, turns_others_away_while_it_has_a_peer) {
    AfterTwoTurns turns;
    UnixServer server(path, &turns);
    const Client first(path);
    CHECK(server.wait_for_peer());
    const Client other(path);
    turns.begin(first);
    STRCMP_EQUAL("late", text_of(server.receive()).c_str());  // it waited twice: once for the other
    STRCMP_EQUAL("", other.receive().c_str());
    CHECK(server.has_peer());
}

TEST(UnixServer, without_a_peer_receives_and_sends_nothing) {
    UnixServer server(path);
    CHECK(server.receive().empty());
    server.send(answer);
    CHECK_FALSE(server.has_peer());
}

TEST(UnixServer, drops_a_peer_that_is_gone_or_takes_nothing) {
    UnixServer server(path);
    auto gone = std::make_unique<Client>(path);
    CHECK(server.wait_for_peer());
    gone.reset();
    server.send(answer);
    CHECK_FALSE(server.has_peer());
    const Client deaf(path);
    CHECK(server.wait_for_peer());
    for (int k = 0; k < 100'000 && server.has_peer(); ++k) {
        server.send(answer);
    }
    CHECK_FALSE(server.has_peer());
}

TEST(UnixServer, refuses_a_path_that_is_none_or_is_in_use) {
    STRCMP_CONTAINS("expected the path of a socket", refusal_of("").c_str());
    STRCMP_CONTAINS("expected the path of a socket", refusal_of(std::string(200, 'x')).c_str());
    STRCMP_CONTAINS("is there and no socket", refusal_of(folder.write("file", "text").string()).c_str());
    STRCMP_CONTAINS("No such file or directory", refusal_of(folder.path("no/such").string()).c_str());
    const UnixServer server(path);
    STRCMP_CONTAINS("another program serves this socket", refusal_of(path).c_str());
}

TEST(UnixServer, replaces_the_socket_of_a_dead_process) {
    const int dead = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    CHECK_EQUAL(0, bind(dead, reinterpret_cast<const sockaddr*>(&address), sizeof address));
    close(dead);
    UnixServer server(path);
    const Client client(path);
    CHECK(server.wait_for_peer());
}
