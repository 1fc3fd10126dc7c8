// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace millforce::host {

/// Called at least every 0.1 s while a UnixServer waits, and before each message is read.
class TurnListener {
  public:
    virtual void on_turn() = 0;

  protected:
    ~TurnListener() = default;
};

/// A Unix socket of type SOCK_SEQPACKET that serves one peer after the other. A message is a whole message or none.
class UnixServer {
  public:
    /// Listens at the path, readable and writable for the user and the group. A socket left by a dead process is
    /// replaced. Throws InputError if the path is too long or in use, or the socket cannot be created.
    /// `listener` outlives this.
    explicit UnixServer(std::string path, TurnListener* listener = nullptr);
    ~UnixServer();
    UnixServer(const UnixServer&) = delete;
    UnixServer& operator=(const UnixServer&) = delete;

    /// Waits for a peer, or for a signal (then false). While there is one, others are turned away.
    bool wait_for_peer();
    [[nodiscard]] bool has_peer() const { return peer_ >= 0; }
    void drop_peer();

    /// Waits for the peer's next message; empty: the peer is gone, or a signal came.
    std::span<const std::uint8_t> receive();
    /// A peer that does not take the message is dropped: this never waits.
    void send(std::span<const std::uint8_t> bytes);

    /// SIGINT, SIGTERM or SIGHUP came since the first server was made.
    [[nodiscard]] bool stop_asked() const { return stop_.load(); }

  private:
    void turn_away_others() const;
    [[nodiscard]] bool wait_readable(int descriptor) const;

    std::string path_;
    TurnListener* turns_;
    const std::atomic<bool>& stop_;
    int listener_ = -1;
    int peer_ = -1;
    std::array<std::uint8_t, 1024> bytes_{};
};

}  // namespace millforce::host
