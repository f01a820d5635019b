#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "compiler/support/control.h"
#include "compiler/support/status.h"
#include "runtime/studio/studio_home.h"

namespace graftal {

struct StudioServerOptions {
    std::string address = "127.0.0.1"; ///< an IP address of this machine
    std::uint16_t port = 0;            ///< 0: any that is free
    std::size_t most_pages = 16;
    /// Makes the home of a new page's session.
    std::function<std::unique_ptr<StudioHome>()> make_home;
};

/// Serves the studio's page, and a session to each page that asks for one, by HTTP and WebSocket.
///
/// Every address holds a random token, which only the caller learns. Requests whose Host is a name other than
/// localhost are refused (DNS rebinding), and sockets whose Origin is not this server. Sizes, rates and
/// numbers of connections are bounded.
class StudioServer {
  public:
    explicit StudioServer(StudioServerOptions options);
    ~StudioServer();
    StudioServer(const StudioServer&) = delete;
    StudioServer& operator=(const StudioServer&) = delete;

    /// Takes the port. Fails where the address is not this machine's, or another program has the port.
    Status open();

    /// The page's address, with the token. Requires that it is open.
    std::string url() const;

    /// Serves until the flag is raised, or stop(); then ends all sessions. Requires that it is open.
    void run(const CancelFlag& cancel = {});
    /// Ends run() soon; any thread may call it.
    void stop();

    /// Pages that have a session now.
    std::size_t pages() const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace graftal
