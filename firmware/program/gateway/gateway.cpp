// SPDX-License-Identifier: Apache-2.0
#include "gateway/gateway.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "files/console.hpp"
#include "files/input_error.hpp"
#include "files/printable.hpp"
#include "report/json_writer.hpp"

namespace millforce::host {

namespace {

constexpr int turn_ms = 100;
constexpr std::uintmax_t most_job_bytes = std::uintmax_t{1024} * 1024;

std::string content_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

void say(const std::string& text) {
    print_line(stderr, "millforce: " + without_controls(text));
}

}  // namespace

Gateway::Gateway(const GatewaySettings& settings)
    : settings_(settings),
      // The broker keeps the session, so that nothing that was sent is forgotten where the connection breaks.
      client_(settings.broker, fmt::format("{}-{}", settings.topic, settings.machine),
              fmt::format("{}/{}/online", settings.topic, settings.machine), *this) {
    if (!settings.tools.empty()) {
        tools_.emplace(settings.tools, tool_files());
    }
    if (!settings.maps.empty()) {
        maps_.emplace(settings.maps, map_files());
    }
    if (!settings.telemetry_socket.empty()) {
        listen_for_telemetry();
    }
}

Gateway::~Gateway() {
    if (telemetry_ >= 0) {
        ::close(telemetry_);
        ::unlink(settings_.telemetry_socket.c_str());
    }
}

std::string Gateway::topic(std::string_view end) const {
    return fmt::format("{}/{}/{}", settings_.topic, settings_.machine, end);
}

/// A socket that a dead gateway left is replaced.
void Gateway::listen_for_telemetry() {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string& path = settings_.telemetry_socket;
    if (path.size() >= sizeof address.sun_path) {
        throw InputError(fmt::format("telemetry_socket: {}: expected a path of at most {} characters", path,
                                     sizeof address.sun_path - 1));
    }
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    telemetry_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const auto* where = reinterpret_cast<const sockaddr*>(&address);
    if (::connect(telemetry_, where, sizeof address) == 0) {
        throw InputError(fmt::format("telemetry_socket: {}: another gateway listens there", path));
    }
    if (struct stat found{}; ::stat(path.c_str(), &found) == 0 && S_ISSOCK(found.st_mode)) {
        ::unlink(path.c_str());
    }
    ::close(telemetry_);
    telemetry_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (::bind(telemetry_, where, sizeof address) != 0 || ::chmod(path.c_str(), 0660) != 0) {
        throw InputError(fmt::format("telemetry_socket: {}: {}", path, std::strerror(errno)));
    }
}

void Gateway::run(const std::atomic<bool>& stop) {
    while (!stop.load()) {
        client_.turn(turn_ms);
        pass_telemetry_on();
        send_next_job();
    }
    if (client_.is_connected()) {
        client_.publish(topic("online"), "0", true);
        client_.disconnect();
    }
}

void Gateway::on_connected() {
    say(fmt::format("{}:{}: connected", settings_.broker.host, settings_.broker.port));
    was_loss_said_ = false;
    client_.publish(topic("online"), "1", true);
    for (const auto& [is_wanted, kind] :
         {std::pair{tools_.has_value(), "tools"}, std::pair{maps_.has_value(), "maps"}}) {
        if (is_wanted) {
            client_.subscribe(topic(fmt::format("{}/+", kind)));
            client_.subscribe(fmt::format("{}/all/{}/+", settings_.topic, kind));
        }
    }
}

void Gateway::on_disconnected(std::string_view reason) {
    job_.reset();  // sent again: a broker may get a report twice, by its id the same
    if (!was_loss_said_) {
        was_loss_said_ = true;
        say(fmt::format("{}:{}: {}: trying again", settings_.broker.host, settings_.broker.port, reason));
    }
}

void Gateway::on_acknowledged(int number) {
    if (job_ && job_->number == number) {
        std::error_code error;
        std::filesystem::remove(job_->file, error);
        job_.reset();
    }
}

/// State is what is now: without a broker it is dropped.
void Gateway::pass_telemetry_on() {
    if (telemetry_ < 0) {
        return;
    }
    std::array<char, 8192> bytes{};
    for (ssize_t count = 0; (count = ::recv(telemetry_, bytes.data(), bytes.size(), 0)) > 0;) {
        const std::string_view text(bytes.data(), static_cast<std::size_t>(count));
        constexpr std::string_view state = "state ";
        constexpr std::string_view event = "event ";
        if (client_.is_connected() && text.starts_with(state)) {
            client_.publish(topic("state"), text.substr(state.size()), true);
        } else if (client_.is_connected() && text.starts_with(event)) {
            (void)client_.publish_acknowledged(topic("event"), text.substr(event.size()), false);
        }
    }
}

std::filesystem::path Gateway::oldest_job() const {
    std::filesystem::path oldest;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(settings_.jobs, error)) {
        const std::string name = entry.path().filename().string();
        const bool is_job = name.starts_with("job-") && name.ends_with(".json") && entry.is_regular_file(error) &&
                            entry.file_size(error) <= most_job_bytes;
        if (is_job && (oldest.empty() || name < oldest.filename().string())) {
            oldest = entry.path();
        }
    }
    return oldest;
}

/// One at a time, in their order.
void Gateway::send_next_job() {
    if (settings_.jobs.empty() || job_ || !client_.is_connected()) {
        return;
    }
    const std::filesystem::path file = oldest_job();
    if (file.empty()) {
        return;
    }
    if (const auto number = client_.publish_acknowledged(topic("job"), content_of(file), false)) {
        job_ = JobOnItsWay{file, *number};
    }
}

void Gateway::on_message(std::string_view name, std::string_view payload) {
    const std::string text(name);
    for (auto* files : {&tools_, &maps_}) {
        const std::string kind = files == &tools_ ? "tools" : "maps";
        for (const std::string& machine : {settings_.machine, std::string("all")}) {
            const std::string prefix = fmt::format("{}/{}/{}/", settings_.topic, machine, kind);
            if (files->has_value() && text.starts_with(prefix) && !payload.empty()) {
                receive_file(**files, kind, text.substr(prefix.size()), payload, machine == settings_.machine);
            }
        }
    }
}

void Gateway::receive_file(ReceivedFiles& files, const std::string& kind, const std::string& name,
                           std::string_view content, bool is_own) {
    const std::string fault = files.receive(name, content, is_own);
    say(fault.empty() ? fmt::format("{}/{}: received", kind, name) : fmt::format("refused: {}", fault));
    JsonWriter json;
    json.begin_object().key("file").text(name).key("accepted").boolean(fault.empty());
    if (!fault.empty()) {
        json.key("reason").text(fault);
    }
    (void)client_.publish_acknowledged(topic(fmt::format("received/{}", kind)), json.end_object().str(), false);
}

}  // namespace millforce::host
