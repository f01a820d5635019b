#include "runtime/studio/server/studio_server.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <list>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <unistd.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>

#include "runtime/studio/server/page_files.h"
#include "runtime/studio/server/page_session.h"
#include "runtime/studio/server/requests.h"

namespace graftal {

namespace serving { // StudioServer::Parts has members of these types

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;
using Error = beast::error_code;
using Request = http::request<http::empty_body>;
using Seconds = std::chrono::duration<double>;

constexpr std::uint32_t most_header_bytes = 16u << 10u;
constexpr std::size_t most_message_bytes = 16u << 20u;
constexpr std::size_t most_connections = 128;
constexpr auto request_seconds = std::chrono::seconds(20);
/// Messages, and their bytes, that a page may send in a second in the long run, and at once.
constexpr double messages_a_second = 500, bytes_a_second = 8e6;
constexpr double most_saved_seconds = 4;

std::string_view view_of(beast::string_view text) {
    return {text.data(), text.size()};
}

class Page;

/// State of the server that its connections share. Used by the server's thread alone.
struct Shared {
    const std::string token = random_token();
    std::size_t most_pages = 0;
    std::function<std::unique_ptr<StudioHome>()> make_home;
    std::atomic<std::size_t> page_count = 0;
    std::size_t connections = 0;
    bool stopping = false;
    asio::io_context context{1};
    std::set<std::shared_ptr<Page>> pages; ///< after what they use

    /// The part of a request's target behind "/TOKEN/"; nothing where the token is wrong.
    std::optional<std::string> path_of(std::string_view target) const {
        target = target.substr(0, target.find('?'));
        if (!target.starts_with('/')) return std::nullopt;
        target.remove_prefix(1);
        const std::size_t slash = target.find('/');
        if (slash == std::string_view::npos || !is_same_secret(target.substr(0, slash), token))
            return std::nullopt;
        return std::string(target.substr(slash + 1));
    }
};

/// A page's socket. It lives until its session's thread has ended.
class Page : public std::enable_shared_from_this<Page> {
  public:
    Page(Shared& shared, beast::tcp_stream stream) : shared_(shared), socket_(std::move(stream)) {}

    void accept(const Request& request) {
        socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
        socket_.read_message_max(most_message_bytes);
        socket_.auto_fragment(false);
        Error ignored; // Small messages follow each other: none waits for the page's word of the one before.
        beast::get_lowest_layer(socket_).socket().set_option(Tcp::no_delay(true), ignored);
        socket_.async_accept(request, [self = shared_from_this()](Error error) {
            if (error || self->shared_.stopping) return self->leave();
            try {
                self->start();
            } catch (const std::exception&) { // no memory, or no thread
                self->stop();
                if (!self->session_) self->leave();
            }
        });
    }

    void stop() {
        if (session_) session_->stop();
        Error ignored;
        beast::get_lowest_layer(socket_).socket().close(ignored);
    }

    void count() { shared_.page_count = shared_.pages.size(); }

  private:
    void start() {
        session_ = std::make_unique<PageSession>(
            shared_.make_home(), [this] { asio::post(shared_.context, [this] { write(); }); },
            // The last post of its thread: what it has posted before is done by then.
            [this] { asio::post(shared_.context, [this] { end(); }); });
        last_read_ = std::chrono::steady_clock::now();
        read();
    }

    void end() {
        session_.reset();
        leave();
    }

    void leave() {
        shared_.pages.erase(shared_from_this());
        count();
    }

    void read() {
        socket_.async_read(buffer_,
                           [self = shared_from_this()](Error error, std::size_t) { self->heard(error); });
    }

    void heard(Error error) {
        if (error || !session_) return stop();
        try {
            const auto bytes = buffer_.cdata();
            session_->hear(socket_.got_text()
                               ? std::string_view(static_cast<const char*>(bytes.data()), bytes.size())
                               : "a binary message");
        } catch (const std::bad_alloc&) {
            return stop();
        }
        const auto now = std::chrono::steady_clock::now();
        const double used =
            std::max(1 / messages_a_second, static_cast<double>(buffer_.size()) / bytes_a_second);
        saved_seconds_ =
            std::min(saved_seconds_ + Seconds(now - last_read_).count(), most_saved_seconds) - used;
        last_read_ = now;
        buffer_.consume(buffer_.size());
        if (buffer_.capacity() > most_kept_bytes) buffer_ = {};
        if (saved_seconds_ >= 0) return read();
        // The page has to wait: its next message is left in the socket.
        pause_.expires_after(
            std::chrono::duration_cast<std::chrono::steady_clock::duration>(Seconds(-saved_seconds_)));
        pause_.async_wait([self = shared_from_this()](Error) { self->read(); });
    }

    void write() {
        try {
            if (writing_ || !session_ || !session_->take(message_)) return;
        } catch (const std::bad_alloc&) {
            return stop();
        }
        writing_ = true;
        socket_.binary(message_.binary);
        socket_.async_write(asio::buffer(message_.bytes),
                            [self = shared_from_this()](Error error, std::size_t) {
                                self->writing_ = false;
                                if (error) return self->stop();
                                self->write();
                            });
    }

    static constexpr std::size_t most_kept_bytes = 1u << 20u;

    Shared& shared_;
    websocket::stream<beast::tcp_stream> socket_;
    std::unique_ptr<PageSession> session_;
    beast::flat_buffer buffer_;
    Outbox::Message message_;
    bool writing_ = false;
    std::chrono::steady_clock::time_point last_read_;
    double saved_seconds_ = most_saved_seconds;
    asio::steady_timer pause_{shared_.context};
};

/// A connection that asks for files, and may become a page's socket.
class Connection : public std::enable_shared_from_this<Connection> {
  public:
    Connection(Shared& shared, Tcp::socket socket) : shared_(shared), stream_(std::move(socket)) {
        ++shared_.connections;
    }
    ~Connection() { --shared_.connections; }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    void read() {
        parser_.emplace();
        parser_->header_limit(most_header_bytes);
        parser_->body_limit(0);
        stream_.expires_after(request_seconds);
        http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](Error error, std::size_t) {
            if (!error && !self->shared_.stopping) self->answer(self->parser_->get());
        });
    }

  private:
    void answer(const Request& request) {
        const std::string_view host = view_of(request[http::field::host]);
        if (!is_own_host(host)) return refuse(request, http::status::misdirected_request, "Unknown host.");
        const std::optional<std::string> path = shared_.path_of(view_of(request.target()));
        if (!path)
            return refuse(request, http::status::not_found,
                          "Open the address that graftal studio has printed.");
        if (*path == "socket" && websocket::is_upgrade(request)) return become_page(request, host);
        if (request.method() != http::verb::get && request.method() != http::verb::head)
            return refuse(request, http::status::method_not_allowed, "Only GET.");
        const std::string_view name = path->empty() ? std::string_view("index.html") : *path;
        for (const PageFile& file : page_files())
            if (file.name == name) return send(request, http::status::ok, file.type, file.bytes);
        refuse(request, http::status::not_found, "There is no such file.");
    }

    void become_page(const Request& request, std::string_view host) {
        if (!is_own_origin(view_of(request[http::field::origin]), host))
            return refuse(request, http::status::forbidden, "A page of another site.");
        if (shared_.pages.size() >= shared_.most_pages)
            return refuse(request, http::status::service_unavailable, "Too many pages are open.");
        stream_.expires_never();
        const auto page = std::make_shared<Page>(shared_, std::move(stream_));
        shared_.pages.insert(page);
        page->count();
        page->accept(request);
    }

    void refuse(const Request& request, http::status status, std::string_view text) {
        send(request, status, "text/plain; charset=utf-8", text);
    }

    void send(const Request& request, http::status status, std::string_view type, std::string_view bytes) {
        auto response =
            std::make_shared<http::response<http::span_body<const char>>>(status, request.version());
        response->set(http::field::content_type, beast::string_view(type.data(), type.size()));
        response->set(http::field::cache_control, "no-store");
        response->set("X-Content-Type-Options", "nosniff");
        response->set("Referrer-Policy", "no-referrer");
        response->set("Cross-Origin-Resource-Policy", "same-origin");
        response->set("Cross-Origin-Opener-Policy", "same-origin");
        response->set("Content-Security-Policy", page_policy(view_of(request[http::field::host])));
        const bool keep = status == http::status::ok && request.keep_alive();
        response->keep_alive(keep);
        if (request.method() != http::verb::head) response->body() = {bytes.data(), bytes.size()};
        response->content_length(bytes.size());
        http::async_write(stream_, *response,
                          [self = shared_from_this(), response, keep](Error error, std::size_t) {
                              if (error) return;
                              if (keep) return self->read();
                              Error ignored;
                              self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
                          });
    }

    Shared& shared_;
    beast::tcp_stream stream_;
    beast::flat_buffer buffer_{most_header_bytes};
    std::optional<http::request_parser<http::empty_body>> parser_;
};

} // namespace serving

using namespace serving;

struct StudioServer::Parts {
    explicit Parts(StudioServerOptions wanted) : options(std::move(wanted)) {
        shared.most_pages = options.most_pages;
        shared.make_home = options.make_home;
    }

    void accept() {
        acceptor.async_accept([this](Error error, Tcp::socket socket) {
            if (shared.stopping) return;
            bool is_served = !error;
            try {
                // One more than are served is closed at once.
                if (!error && shared.connections < most_connections)
                    std::make_shared<Connection>(shared, std::move(socket))->read();
            } catch (const std::bad_alloc&) {
                is_served = false;
            }
            if (is_served) return accept();
            // No descriptor is left, say, or no memory: later there may be.
            again.expires_after(std::chrono::milliseconds(100));
            again.async_wait([this](Error stopped) {
                if (!stopped) accept();
            });
        });
    }

    void end() {
        shared.stopping = true;
        Error ignored;
        acceptor.close(ignored);
        again.cancel();
        raised.reset();
        for (const std::shared_ptr<Page>& page : std::set(shared.pages))
            page->stop();
        wait_for_pages();
    }

    /// The context runs on until the last session's thread has ended.
    void wait_for_pages() {
        if (shared.pages.empty()) return shared.context.stop();
        again.expires_after(std::chrono::milliseconds(5));
        again.async_wait([this](Error) { wait_for_pages(); });
    }

    StudioServerOptions options;
    Shared shared;
    Tcp::acceptor acceptor{shared.context};
    asio::steady_timer again{shared.context};
    std::optional<asio::posix::stream_descriptor> raised;
};

StudioServer::StudioServer(StudioServerOptions options)
    : parts_(std::make_unique<Parts>(std::move(options))) {}

StudioServer::~StudioServer() = default;

Status StudioServer::open() {
    const StudioServerOptions& options = parts_->options;
    Error error;
    const asio::ip::address address = asio::ip::make_address(options.address, error);
    if (error) return Status::failure(fmt::format("'{}' is not an IP address", options.address));
    const Tcp::endpoint endpoint(address, options.port);
    Tcp::acceptor& acceptor = parts_->acceptor;
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (!error) return {};
    return Status::failure(
        fmt::format("cannot serve on port {} of {}: {}", options.port, options.address, error.message()));
}

std::string StudioServer::url() const {
    const Tcp::endpoint endpoint = parts_->acceptor.local_endpoint();
    const asio::ip::address address = endpoint.address();
    const std::string name = address.is_unspecified() ? "127.0.0.1" : address.to_string();
    return fmt::format("http://{}:{}/{}/",
                       address.is_v6() && !address.is_unspecified() ? "[" + name + "]" : name,
                       endpoint.port(), parts_->shared.token);
}

void StudioServer::run(const CancelFlag& cancel) {
    Parts& parts = *parts_;
    parts.accept();
    if (cancel.wake_descriptor() >= 0) {
        parts.raised.emplace(parts.shared.context, ::dup(cancel.wake_descriptor()));
        parts.raised->async_wait(asio::posix::descriptor_base::wait_read, [&parts](Error error) {
            if (!error) parts.end();
        });
    }
    for (;;) {
        try {
            parts.shared.context.run();
            break;
        } catch (const std::bad_alloc&) {
            // The work at hand is left: a connection ends by its clock, a page when it is closed.
        }
    }
}

void StudioServer::stop() {
    asio::post(parts_->shared.context, [this] { parts_->end(); });
}

std::size_t StudioServer::pages() const {
    return parts_->shared.page_count;
}

} // namespace graftal
