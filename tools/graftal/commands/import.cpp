#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/importers.h"
#include "compiler/support/control.h"
#include "compiler/support/printable.h"
#include "compiler/support/stage_work.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"
#include "runtime/system/made_folders.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

class Importing {
  public:
    explicit Importing(const Options& options)
        : options_(options), output_(options.render.output), path_(model_path(options.operands.front())) {}

    int run() {
        const int status = import_within_limits();
        made_.take_back(); // where nothing was written
        conclude(options_, found_);
        return status;
    }

  private:
    int import_within_limits() {
        constexpr double most_seconds = 10;
        StageWork work(most_seconds);
        Control control;
        control.work = &work;
        try {
            WorkMeter meter(control, "import", 10'000);
            return import_file(meter);
        } catch (const OutOfWork&) {
            found_.diagnostics
                .error(Span(), fmt::format("to translate '{}' takes more than {} seconds of work", path_.file,
                                           most_seconds))
                .with_hint("ask for less: fewer shapes, turns of loops, or calls of functions");
            return exit_fault;
        }
    }

    int import_file(WorkMeter& meter) {
        const LowerOptions& lower = options_.render.compile.lower;
        const std::string& root = lower.root;
        if (!is_foreign(path_.file)) {
            Diagnostic& error = found_.diagnostics.error(
                Span(), fmt::format("'{}' is of no format that graftal imports", path_.file));
            if (std::error_code ignored; std::filesystem::is_directory(path_.file, ignored))
                error.with_hint("it is " + special_file_text(path_.file));
            return exit_fault;
        }
        if (path_.file != "-" && !root.empty() && !lies_in(path_.file, root)) {
            found_.diagnostics.error(Span(), fmt::format("'{}' leads out of --root '{}'", path_.file, root));
            return exit_fault;
        }
        std::string text;
        found_.status = read_text(path_.file, text);
        if (!found_.status.ok()) return exit_environment;
        const FileId file = found_.sources.add(path_.file, model_text(path_.file, std::move(text)));
        const ForeignFile foreign = foreign_file(file, found_.sources, found_.diagnostics,
                                                 {root, &disk_files(), lower.seed.value_or(0)}, &meter);
        const Importer* const importer = importer_of(foreign);
        if (!importer) return exit_fault;
        if (path_.model.empty() && output_.ends_with('/')) return import_all(*importer, foreign);
        if (path_.model.empty() && output_.empty()) {
            const std::vector<ForeignModel> models = importer->models(foreign);
            if (models.size() > 1) return list(models);
        }
        const std::optional<ForeignModel> model = find_model(*importer, foreign, path_.model);
        if (!model) return exit_fault;
        if (output_.ends_with('/'))
            return make_folder() ? write(*importer, foreign, *model, "") : exit_environment;
        return write(*importer, foreign, *model, output_.empty() ? "-" : output_);
    }

    static int list(const std::vector<ForeignModel>& models) {
        std::string names;
        for (const ForeignModel& model : models)
            names += escaped(model.name) + "\n";
        return print_output(names);
    }

    bool make_folder() {
        found_.status = made_.make(output_);
        return found_.status.ok();
    }

    int import_all(const Importer& importer, const ForeignFile& foreign) {
        if (!make_folder()) return exit_environment;
        int result = exit_done;
        std::size_t written = 0;
        const std::vector<ForeignModel> models = importer.models(foreign);
        for (const ForeignModel& model : models) {
            const int status = write(importer, foreign, model, "");
            if (status == exit_environment) return status;
            if (status == exit_done) ++written;
            result = std::max(result, status);
            print_findings(options_, found_); // now: after a hundred errors of one file no more are told
            found_.diagnostics = {};
        }
        if (!options_.quiet)
            say(fmt::format("{} of {} models imported to {}\n", written, models.size(), output_));
        return result;
    }

    /// `target`: "" for a name of its own in the folder.
    int write(const Importer& importer, const ForeignFile& foreign, const ForeignModel& model,
              std::string target) {
        const std::size_t errors = found_.diagnostics.error_count();
        const std::optional<Translation> translation = importer.translate(foreign, model);
        if (!translation || found_.diagnostics.error_count() > errors) return exit_fault;
        if (target.empty()) target = free_name(model, *translation);
        const std::string ending = "." + std::string(translation->extension);
        if (target != "-" && !target.ends_with(ending)) {
            found_.diagnostics.error(Span(), fmt::format("'{}': '{}' becomes a model whose name ends in {}",
                                                         target, model.name, ending));
            return exit_fault;
        }
        if (target == "-") return print_output(translation->text);
        found_.status = write_text(target, translation->text);
        return found_.status.ok() ? exit_done : exit_environment;
    }

    std::string free_name(const ForeignModel& model, const Translation& translation) {
        const std::string stem = plain_name(model.name);
        std::string name = stem;
        for (int i = 2; !taken_.insert(name).second; ++i)
            name = fmt::format("{}_{}", stem, i);
        return (std::filesystem::path(output_) / fmt::format("{}.{}", name, translation.extension)).string();
    }

    const Options& options_;
    std::string output_;
    ModelPath path_;
    Compilation found_;
    std::set<std::string> taken_;
    MadeFolders made_;
};

} // namespace

int run_import(const Options& options) {
    return Importing(options).run();
}

} // namespace graftal
