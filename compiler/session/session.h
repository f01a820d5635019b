#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/detail/prepare.h"
#include "compiler/light/clouds.h"
#include "compiler/lower/parsed_files.h"
#include "compiler/session/memo.h"
#include "compiler/session/stage_options.h"
#include "compiler/session/stages.h"
#include "compiler/session/values.h"
#include "compiler/support/control.h"

namespace graftal {

/// Values that a session keeps.
enum class Keep {
    everything, ///< the last value of each stage
    for_views,  ///< values for the next view: for animations
    nothing,    ///< each value only until the next stage has used it: for a single picture
};

/// Number of runs of each stage.
struct StageRuns {
    std::uint64_t source = 0;
    std::uint64_t parsed = 0; ///< texts of all files, each by itself
    std::uint64_t lowered = 0;
    std::uint64_t analysed = 0;
    std::uint64_t viewed = 0;
    std::uint64_t prepared = 0;
    bool operator==(const StageRuns&) const = default;
};

/// A model on its way from text to picture: owns the last value of each stage, and runs a stage again exactly
/// if its inputs are others than those of its last run (README.md). Used by one thread at a time; the values
/// that it gives may be read by many, and outlive it.
///
/// Each function gives a value, or null after errors in `diagnostics` or with a failed `status`. What it puts
/// into the compilation is what a fresh run would say; `times` gets only what was run.
class Session {
  public:
    /// A model in a file, "-" for standard input, which is read once and when it is asked for. `files`
    /// outlive it.
    Session(std::string path, const Files& files, Keep keep = Keep::everything);
    /// A model that is a text already, and uses no files. `name` decides the language.
    Session(std::string name, std::string text, Keep keep = Keep::everything);

    /// Long stages are ended and followed by this from now on. A stage that is cancelled gives null, and a
    /// failed status: "interrupted". Its account of work does not count: stages up to the analysis may take
    /// stage_work_limit() together, and more is an error.
    void set_control(Control control) { control_ = std::move(control); }
    const Control& control() const { return control_; }

    /// The model's own text is this from now on, whatever its file says.
    void edit(std::string text);
    /// Looks whether files have changed, those that the model names too; a text that was given stays.
    /// `textures_changed`: some picture that was looked at is another one now.
    void reload(bool textures_changed = false);

    /// Without this, textures are taken on trust.
    void look_at_textures(LookAtTexture look) { look_at_texture_ = std::move(look); }
    /// Without this, pictures of skies are not looked at, and count as white.
    void load_sky_pictures(LoadSkyPicture load) { load_sky_picture_ = std::move(load); }
    /// Without this, models of other programs are not read.
    void translate_with(Translator translator) { translator_ = translator; }
    /// Sees the graph after each pass, for models and for detail.
    void after_each_pass(PassObserver observer) { after_pass_ = std::move(observer); }

    /// The model before passes; one that is an orbit has no graph (LowerOptions::may_be_orbit).
    std::shared_ptr<const LoweredModel> lowered(const StageOptions& options, Compilation& compilation);
    /// One that does not converge is an error, unless it is wanted `for_report`: then the verdict is part of
    /// the result. Null without an error for an orbit that is accepted.
    std::shared_ptr<const AnalysedModel> analysed(const StageOptions& options, Compilation& compilation,
                                                  bool for_report = false);
    std::shared_ptr<const ViewedModel> viewed(const StageOptions& options, Compilation& compilation);
    /// The graph made ready for any engine. An unfolding without an end is an error.
    std::shared_ptr<const PreparedGraph> prepared(const StageOptions& options, Compilation& compilation);

    /// Gives up what `keep` does not want kept while another program draws.
    void yield_memory();

    StageRuns runs() const;

  private:
    struct SourceKey {
        std::string root;
        std::uint64_t edits = 0;
        bool operator==(const SourceKey&) const = default;
    };
    struct LowerKey {
        std::shared_ptr<const Source> source;
        std::uint64_t files = 0; ///< how often those that it names were found to have changed
        LowerOptions options;
        double work_seconds = 0; ///< allowed
        // Whether the value depends on these options.
        bool reads_steps = true;
        bool reads_time = true;
        bool limited_by_work = true;
        /// An option that the lowering of either key did not read is not compared.
        bool operator==(const LowerKey& other) const;
    };
    struct AnalyseKey {
        std::uint64_t lowered = 0;
        std::string stop_after;
        std::optional<Address> at; ///< of a zoom: it is found by names, which passes do not keep
        bool operator==(const AnalyseKey&) const = default;
    };
    struct ViewKey {
        std::uint64_t analysed = 0;
        std::optional<unsigned> steps;
        ViewOptions options;
        int cloud_rows = 0; ///< by the work allowed
        bool operator==(const ViewKey&) const = default;
    };
    struct PrepareKey {
        std::uint64_t analysed = 0;
        std::uint64_t viewed = 0; ///< under a zoom, which gives the graph a new root; else 0
        PrepareOptions options;
        bool operator==(const PrepareKey&) const = default;
    };
    /// Runs `work` and gives its value. Null, with a failed status, if it was cancelled; null after an error
    /// if it would take more than is allowed.
    template<typename Value, typename Work>
    std::shared_ptr<const Value> unless_ended(Compilation& compilation, const Work& work);
    /// The control, with an account for the work of a stage.
    Control charging(StageWork& work) const;
    LoweredModel take_lowered();

    // Each sees to it that its memo is of these options and, if it is `wanted`, has a value. False where the
    // stage or one before it failed. The compilation gets the findings.
    bool need_source(const StageOptions& options, Compilation& compilation);
    bool need_lowered(const StageOptions& options, bool wanted, Compilation& compilation);
    bool need_analysed(const StageOptions& options, bool wanted, Compilation& compilation);
    bool need_viewed(const StageOptions& options, Compilation& compilation);
    bool need_prepared(const StageOptions& options, Compilation& compilation);

    std::string path_;
    std::optional<std::string> text_; ///< in place of the file's
    const Files& files_;
    std::uint64_t edits_ = 0;
    std::uint64_t file_changes_ = 0;
    LookAtTexture look_at_texture_;
    LoadSkyPicture load_sky_picture_;
    Translator translator_ = no_translator();
    PassObserver after_pass_;
    Keep keep_;
    Control control_;
    std::shared_ptr<CloudPictures> clouds_ = std::make_shared<CloudPictures>();
    StageRuns runs_; ///< apart from those of parsers

    std::optional<SourceKey> source_key_;
    std::shared_ptr<const Source> source_;
    ParsedFiles parsed_;
    Memo<LowerKey, LoweredModel> lowered_;
    SourceMap sources_;                       ///< of the last lowering
    std::map<std::string, FileStamp> meshes_; ///< meshes that the last lowering read
    bool reads_steps_ = true;                 ///< the last lowering: its value depends on steps
    Memo<AnalyseKey, AnalysedModel> analysed_;
    Memo<ViewKey, ViewedModel> viewed_;
    Memo<PrepareKey, PreparedGraph> prepared_;
};

} // namespace graftal
