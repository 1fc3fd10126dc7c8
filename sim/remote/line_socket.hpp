// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace millforce::sim {

/// Lines of text over a Unix stream socket to a program that listens there. The other side is not trusted: it may die,
/// be silent, or send without end. Every wait ends. Errors are InputError; that of the constructor names the path.
class LineSocket {
  public:
    using Patience = std::chrono::duration<double>;
    /// Of a line that is received. Longer ones could keep a parser of JSON busy for seconds, by nesting.
    static constexpr std::size_t longest_line = 4096;

    /// Connects; where nobody listens yet, tries again for as long as `patience`.
    LineSocket(const std::string& path, Patience patience);
    ~LineSocket();
    LineSocket(const LineSocket&) = delete;
    LineSocket& operator=(const LineSocket&) = delete;

    /// The line break is added. Never waits: who lets the socket's buffer fill does not read.
    void send(std::string_view line);
    /// The next line without its break, valid until the next call. `awaited` is named in errors, e.g. "the answer to
    /// sample 3".
    std::string_view receive(std::string_view awaited);
    /// Whether bytes have come that nobody asked for yet.
    [[nodiscard]] bool has_more() const;

  private:
    [[nodiscard]] bool connect_once(const std::string& path);
    void wait_for_bytes(std::chrono::steady_clock::time_point end, std::string_view awaited) const;
    void take_bytes(std::string_view awaited);

    Patience patience_;
    int socket_ = -1;
    std::string line_;
    std::string received_;  ///< not yet handed out
};

}  // namespace millforce::sim
