#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/detail/detail_options.h"
#include "compiler/graph/settings.h"
#include "compiler/session/session.h"
#include "compiler/support/files.h"
#include "compiler/support/workers.h"
#include "runtime/image/image.h"
#include "runtime/studio/files/stored.h"
#include "runtime/trace/model/trace_model.h"

namespace graftal {

/// The door by which a session's messages leave it. Called by the thread that works.
class StudioSink {
  public:
    virtual ~StudioSink() = default;
    virtual void text(const std::string& message) = 0;
    virtual void binary(const std::string& message) = 0;
};

/// The model that a page opens with.
struct OpenedModel {
    std::string name; ///< a path, whose ending is the language's
    std::string text;
};

/// A file that the page wants, made of the state as the command line makes it.
struct FileJob {
    std::vector<std::string> words; ///< of the command line, without its output; of `render` or `export`
    OpenedModel model;              ///< as the page has it now
    std::string path;               ///< where it goes, from where the home was started; "": into memory
    std::string suffix;             ///< of a file in memory
    std::map<std::string, std::string> files{}; ///< StudioState::files, of which none leads out of the root
};

/// The part of a job that is done: each stage goes from 0 to 1.
struct FileShare {
    std::string stage; ///< "measure", "draw", "assemble", or "fit" of maps
    double share = 0;
};

/// The file of a job, or why there is none.
struct FileResult {
    std::string error;
    std::string path;     ///< as it was written; "" in memory
    std::string name;     ///< in memory
    std::string contents; ///< likewise
};

/// The doors from a studio's session to the world: the program `graftal studio`, or a page alone, stand
/// behind them. Used by the thread that works.
class StudioHome {
  public:
    virtual ~StudioHome() = default;

    virtual std::string name() const = 0; ///< "program" or "browser"
    virtual std::string version() const = 0;
    virtual OpenedModel opened() const = 0;
    virtual std::vector<std::string> engines() const { return {"native"}; }
    virtual std::vector<std::string> formats() const { return {}; } ///< of export: their endings

    virtual const Files& files() const = 0;
    virtual std::string root() const { return {}; } ///< LowerOptions::root
    virtual std::uint64_t memory_bytes() const { return DetailOptions{}.memory_bytes; } ///< likewise of those
    /// The bytes as zlib has them, for the way to the page; here without compression.
    virtual std::string deflated(std::string_view bytes) const { return stored(bytes); }
    /// `threads`: 0 for as many as the home likes. Valid until the next call.
    virtual const Workers& workers(int threads) = 0;
    /// Gives a new session what it asks of textures, skies and foreign models.
    virtual void equip(Session&) {}
    /// Reader of foreign models.
    virtual Translator translator() const { return no_translator(); }
    /// Reads the textures of the materials and the ground.
    virtual Status load_textures(const Graph&, const View&, ModelTextures&) { return {}; }

    using OnShare = std::function<void(const FileShare& share)>;
    using OnResult = std::function<void(FileResult result)>;
    /// Makes a file beside the session's work, and calls the functions at any time, by any thread; the last
    /// once.
    virtual void make_file(FileJob, CancelFlag, OnShare, OnResult on_result) {
        on_result({"this home writes no files", {}, {}, {}});
    }
    using OnPicture = std::function<void(const Image& developed)>;
    using OnEnd = std::function<void(std::string error)>;
    /// Has another engine than the native one draw the job's picture, beside the session's work: coarse
    /// first, where the engine does so. Calls the functions by any thread; the last once, with "" where all
    /// is well.
    virtual void draw_picture(FileJob, CancelFlag, OnPicture, OnEnd on_end) {
        on_end("this home has no such engine");
    }
    /// Waits for the end of what these two have begun: none of their functions is called after it.
    virtual void end_jobs() {}
};

} // namespace graftal
