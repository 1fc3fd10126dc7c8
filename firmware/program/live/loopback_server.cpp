// SPDX-License-Identifier: Apache-2.0
#include "live/loopback_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "files/console.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

namespace {

constexpr unsigned most_connections = 32;
constexpr unsigned most_streams = 8;
constexpr std::size_t bytes_per_connection = std::size_t{16} * 1024;
constexpr unsigned patience_s = 10;
constexpr int steps_per_turn = 8;

constexpr std::string_view content_security_policy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; img-src 'self' "
    "data:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The port that a socket has got.
std::uint16_t port_of(int listener) {
    sockaddr_storage address{};
    socklen_t length = sizeof address;
    ::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &length);
    in_port_t port = 0;  // at the same place in both kinds of addresses
    static_assert(offsetof(sockaddr_in, sin_port) == offsetof(sockaddr_in6, sin6_port));
    std::memcpy(&port, reinterpret_cast<const char*>(&address) + offsetof(sockaddr_in, sin_port), sizeof port);
    return ntohs(port);
}

/// Listens on an address of this computer alone. -1, with errno: it cannot.
template <typename Address>
int listen_on(const Address& address, int family) {
    const int listener = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const int yes = 1;
    if (listener < 0) {
        return -1;
    }
    ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (family == AF_INET6) {
        ::setsockopt(listener, IPPROTO_IPV6, IPV6_V6ONLY, &yes, sizeof yes);
    }
    constexpr int backlog = 32;  // of those that come within one turn
    if (::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(listener, backlog) != 0) {
        const int error = errno;
        ::close(listener);
        errno = error;
        return -1;
    }
    return listener;
}

int listen_on_loopback_4(std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return listen_on(address, AF_INET);
}

int listen_on_loopback_6(std::uint16_t port) {
    sockaddr_in6 address{};
    address.sin6_family = AF_INET6;
    address.sin6_port = htons(port);
    address.sin6_addr = in6addr_loopback;
    return listen_on(address, AF_INET6);
}

std::string_view header(MHD_Connection* connection, const char* name) {
    const char* value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
    return value != nullptr ? value : std::string_view();
}

void add_headers(MHD_Response* response, const char* content_type) {
    for (const auto& [key, value] :
         {std::pair{"Content-Type", content_type}, std::pair{"Cache-Control", "no-store"},
          std::pair{"X-Content-Type-Options", "nosniff"}, std::pair{"Cross-Origin-Resource-Policy", "same-origin"},
          std::pair{"Referrer-Policy", "no-referrer"},
          std::pair{"Content-Security-Policy", content_security_policy.data()}}) {
        MHD_add_response_header(response, key, value);
    }
}

MHD_Result answer(MHD_Connection* connection, unsigned status, const WebResource& resource) {
    MHD_Response* response = MHD_create_response_from_buffer(
        resource.body.size(), const_cast<char*>(resource.body.data()), MHD_RESPMEM_MUST_COPY);  // it does not write
    if (response == nullptr) {
        return MHD_NO;
    }
    add_headers(response, resource.content_type.c_str());
    if (status == MHD_HTTP_METHOD_NOT_ALLOWED) {
        MHD_add_response_header(response, "Allow", "GET, HEAD");
    }
    const MHD_Result result = MHD_queue_response(connection, status, response);
    MHD_destroy_response(response);
    return result;
}

MHD_Result refuse(MHD_Connection* connection, unsigned status, const std::string& reason) {
    return answer(connection, status, {"text/plain; charset=utf-8", reason + "\n", status});
}

}  // namespace

class LoopbackServer::Daemon {
  public:
    Daemon(LoopbackServer& server, int listener) : server_(server), listener_(listener) {}
    ~Daemon() {
        if (daemon_ != nullptr) {
            MHD_stop_daemon(daemon_);  // closes the listener, too
        } else {
            ::close(listener_);
        }
    }
    Daemon(const Daemon&) = delete;
    Daemon& operator=(const Daemon&) = delete;

    /// Without threads: all is done in turn().
    bool start() {
        daemon_ =
            MHD_start_daemon(MHD_USE_EPOLL, 0, nullptr, nullptr, on_request, this, MHD_OPTION_LISTEN_SOCKET, listener_,
                             MHD_OPTION_CONNECTION_LIMIT, most_connections, MHD_OPTION_CONNECTION_MEMORY_LIMIT,
                             bytes_per_connection, MHD_OPTION_CONNECTION_TIMEOUT, patience_s,
                             MHD_OPTION_STRICT_FOR_CLIENT, 1, MHD_OPTION_SIGPIPE_HANDLED_BY_APP, 1, MHD_OPTION_END);
        return daemon_ != nullptr;
    }
    void turn() {
        for (int k = 0; k < steps_per_turn && daemon_ != nullptr; ++k) {
            MHD_run(daemon_);
        }
    }

  private:
    /// A reader of `/events`.
    struct Stream {
        LoopbackServer& server;
        std::uint64_t next = 0;  ///< number of the message to send
        std::size_t sent = 0;    ///< bytes of `message`
        std::string message{};
    };

    static MHD_Result on_request(void* self, MHD_Connection* connection, const char* path, const char* method,
                                 const char*, const char*, std::size_t*, void**) {
        return static_cast<Daemon*>(self)->respond(connection, path, method);
    }
    MHD_Result respond(MHD_Connection* connection, std::string_view path, std::string_view method);
    [[nodiscard]] bool is_for_this_computer(std::string_view host) const;
    MHD_Result begin_stream(MHD_Connection* connection);
    static ssize_t read_stream(void* stream, std::uint64_t, char* bytes, std::size_t most);
    static void end_stream(void* stream);

    LoopbackServer& server_;
    int listener_;
    MHD_Daemon* daemon_ = nullptr;
};

bool LoopbackServer::Daemon::is_for_this_computer(std::string_view host) const {
    constexpr std::uint16_t default_port = 80;  // a browser leaves it out
    const std::string port = server_.port_ == default_port ? "" : fmt::format(":{}", server_.port_);
    return host == "localhost" + port || host == "127.0.0.1" + port || host == "[::1]" + port;
}

MHD_Result LoopbackServer::Daemon::respond(MHD_Connection* connection, std::string_view path, std::string_view method) {
    if (!is_for_this_computer(header(connection, "Host"))) {
        return refuse(connection, MHD_HTTP_FORBIDDEN,
                      fmt::format("expected the host 127.0.0.1:{0} or localhost:{0}", server_.port_));
    }
    if (method != "GET" && method != "HEAD") {
        return refuse(connection, MHD_HTTP_METHOD_NOT_ALLOWED, "expected GET");
    }
    if (path == "/events" && server_.stream_ != nullptr) {
        return begin_stream(connection);
    }
    if (const auto resource = server_.pages_.resource(path)) {
        return answer(connection, resource->status, *resource);
    }
    return refuse(connection, MHD_HTTP_NOT_FOUND, "no such page");
}

MHD_Result LoopbackServer::Daemon::begin_stream(MHD_Connection* connection) {
    if (const std::string_view site = header(connection, "Sec-Fetch-Site"); site == "cross-site") {
        return refuse(connection, MHD_HTTP_FORBIDDEN, "not for pages of other sites");
    }
    if (server_.streams_ >= most_streams) {
        return refuse(connection, MHD_HTTP_SERVICE_UNAVAILABLE, "too many pages are open");
    }
    auto stream = std::make_unique<Stream>(Stream{server_, server_.stream_->oldest()});
    stream->message = "retry: 1000\n\n";
    constexpr std::size_t block_bytes = 4096;
    MHD_Response* response =
        MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, block_bytes, read_stream, stream.get(), end_stream);
    if (response == nullptr) {
        return MHD_NO;
    }
    (void)stream.release();  // of the response now: end_stream()
    ++server_.streams_;
    add_headers(response, "text/event-stream");
    const MHD_Result result = MHD_queue_response(connection, MHD_HTTP_OK, response);
    MHD_destroy_response(response);
    return result;
}

/// 0: there is nothing yet.
ssize_t LoopbackServer::Daemon::read_stream(void* self, std::uint64_t, char* bytes, std::size_t most) {
    Stream& stream = *static_cast<Stream*>(self);
    if (stream.sent == stream.message.size()) {
        const std::string* message = stream.server.stream_->at(stream.next);
        if (message == nullptr) {
            return 0;
        }
        stream.message = *message;
        stream.sent = 0;
        ++stream.next;
    }
    const std::size_t count = std::min(most, stream.message.size() - stream.sent);
    std::copy_n(stream.message.data() + stream.sent, count, bytes);
    stream.sent += count;
    return static_cast<ssize_t>(count);
}

void LoopbackServer::Daemon::end_stream(void* self) {
    const std::unique_ptr<Stream> stream(static_cast<Stream*>(self));
    --stream->server.streams_;
}

LoopbackServer::LoopbackServer(std::uint16_t port, const WebPages& pages, const LiveMessages* stream)
    : pages_(pages), stream_(stream) {
    const int listener = listen_on_loopback_4(port);
    if (listener < 0) {
        throw InputError(fmt::format("--web: port {} of 127.0.0.1: {}", port, std::strerror(errno)));
    }
    daemons_.push_back(std::make_unique<Daemon>(*this, listener));
    port_ = port_of(listener);
    if (const int second = listen_on_loopback_6(port_); second >= 0) {
        daemons_.push_back(std::make_unique<Daemon>(*this, second));
    } else if (errno == EADDRINUSE) {
        throw InputError(fmt::format("--web: port {} of ::1: {}", port_, std::strerror(errno)));
    }  // else this computer has no IPv6
}

LoopbackServer::~LoopbackServer() = default;

void LoopbackServer::start() {
    for (const auto& daemon : daemons_) {
        if (!daemon->start()) {
            print_line(stderr, "millforce: --web: the page cannot be served");
        }
    }
}

void LoopbackServer::turn() {
    for (const auto& daemon : daemons_) {
        daemon->turn();
    }
}

}  // namespace millforce::host
