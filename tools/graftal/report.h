#pragma once

#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/session/values.h"
#include "runtime/render/picture_session.h"
#include "tools/graftal/options.h"

namespace graftal {

/// TEXT on standard error, which may be closed: lines, with control characters escaped.
void say(const std::string& text);

/// "graftal: TEXT" on standard error.
void complain(std::string_view text);

/// Prints the diagnostics, the failed status if there is one, and the times if they were asked for.
void print_findings(const Options& options, const Compilation& compilation);

/// Prints the findings; returns the exit status that follows. `signal`: that interrupted the command, or 0.
int conclude(const Options& options, const Compilation& compilation, int signal = 0);

/// Whether both names are of one place, by whatever links.
bool same_place(const std::string& a, const std::string& b);

/// Refuses, with an error, an output that nobody has named where it is one of the files that the model
/// `uses`: a picture by the model's name may be its texture.
bool refuse_own_file(const Options& options, const std::vector<std::string>& uses, Compilation& compilation);

/// Says that the memory did not suffice, and for what, without taking any; returns the exit status that
/// follows.
int conclude_out_of_memory(const std::bad_alloc& fault) noexcept;

/// Options of the stages for a command that only tells of the model: little work, where --work does not say.
/// Colours may be left out where only shapes are told of.
StageOptions inspecting(const Options& options, bool shapes_only = false);

/// Writes to standard output; exit status 0, or 3 with a complaint if it is closed or full.
int print_output(std::string_view text);

/// The session of a command, with `--dump-after` connected.
class CommandSession : public PictureSession {
  public:
    CommandSession(const Options& options, const std::string& path, Keep keep = Keep::nothing,
                   const Files& files = disk_files());
};

} // namespace graftal
