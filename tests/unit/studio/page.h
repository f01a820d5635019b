#pragma once

// A session with a home in memory, for tests: what it says is kept.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "runtime/studio/studio_session.h"

namespace graftal {

class MemoryHome final : public StudioHome {
  public:
    std::string name() const override { return "browser"; }
    std::string version() const override { return "test"; }
    OpenedModel opened() const override { return model; }
    const Files& files() const override { return texts; }
    std::string root() const override { return folder; }
    const Workers& workers(int) override { return *hands; }

    OpenedModel model{"crystal.rifs", "rifs crystal { }"};
    MemoryFiles texts;
    std::string folder; ///< out of which no file is used; "": any may be
    SerialWorkers alone;
    const Workers* hands = &alone;
};

struct SeenTile {
    std::uint32_t number = 0, pass = 0;
    int x = 0, y = 0, width = 0, height = 0, block = 0;
    std::string rgb;
};

/// Reads a binary message; nothing is checked but its mark.
SeenTile read_tile(const std::string& message);

class Page final : public StudioSink {
  public:
    void text(const std::string& message) override {
        heard.push_back(nlohmann::json::parse(message));
        if (on_message) on_message();
    }
    void binary(const std::string& message) override {
        tiles.push_back(read_tile(message));
        if (on_message) on_message();
    }

    void say(const nlohmann::json& message) { session.hear(message.dump()); }
    /// A state of 64x36 pixels, which the fields change; its number.
    std::uint32_t show(nlohmann::json fields);
    /// Until there is nothing to do.
    void work() {
        while (session.work(0.05)) {
        }
    }
    /// Until there is nothing to do, or `enough` says so.
    void work_until(const std::function<bool()>& enough) {
        while (!enough() && session.work(0.01)) {
        }
    }
    /// The answer to an ask.
    nlohmann::json ask(const std::string& what, nlohmann::json fields = nlohmann::json::object());

    /// The last message of the type; null where there is none.
    nlohmann::json last(const std::string& type) const;
    std::size_t count(const std::string& type) const;
    /// The last picture, by its tiles: rows of red, green and blue.
    std::string picture(int width = 64, int height = 36) const;

    MemoryHome home;
    std::vector<nlohmann::json> heard;
    std::vector<SeenTile> tiles;
    std::function<void()> on_message;
    std::uint32_t number = 0, id = 1u << 30u;
    StudioSession session{home, *this};
};

/// A cloud of spheres whose maps are `spread` apart.
inline constexpr const char* crystal = "let spread = 0.5\n"
                                       "rifs crystal {\n"
                                       "  map n { scale 1/2  translate <0, spread, 0> }\n"
                                       "  map s { scale 1/2  translate <0, -spread, 0> }\n"
                                       "  map e { scale 1/2  translate <spread, 0, 0> }\n"
                                       "  terminal sphere\n"
                                       "}\n";

} // namespace graftal
