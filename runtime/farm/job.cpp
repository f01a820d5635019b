#include "runtime/farm/job.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "compiler/support/file.h"
#include "runtime/image/image.h"
#include "runtime/render/frame_store.h"

namespace graftal {

namespace {

using Json = nlohmann::ordered_json;

constexpr int format = 1; ///< of the manifest
constexpr std::size_t most_manifest_bytes = 256u << 20;

Json json_of(const PictureFit& fit) {
    const Sampling& sampling = fit.sampling;
    return {{"size", {fit.size.width, fit.size.height}},
            {"error_px", fit.error_px},
            {"error_world", fit.error_world ? Json(*fit.error_world) : Json(nullptr)},
            {"most_visits", fit.most_visits},
            {"block", sampling.block},
            {"antialias", sampling.antialias ? Json(*sampling.antialias) : Json(nullptr)},
            {"most_samples", sampling.most_samples},
            {"noise_255", sampling.noise_255},
            {"seconds", fit.seconds}};
}

PictureFit fit_from(const Json& json) {
    PictureFit fit;
    fit.size = {json.at("size").at(0), json.at("size").at(1)};
    fit.error_px = json.at("error_px");
    if (!json.at("error_world").is_null()) fit.error_world = json.at("error_world").get<double>();
    fit.most_visits = json.at("most_visits");
    fit.sampling.block = json.at("block");
    if (!json.at("antialias").is_null()) fit.sampling.antialias = json.at("antialias").get<int>();
    fit.sampling.most_samples = json.at("most_samples");
    fit.sampling.noise_255 = json.at("noise_255");
    fit.seconds = json.at("seconds");
    return fit;
}

Json json_of(const Job& job) {
    Json files = Json::array(), axes = Json::array();
    for (const JobFile& file : job.files)
        files.push_back({{"name", file.name}, {"digest", file.digest}});
    for (const SweepAxis& axis : job.axes)
        axes.push_back({{"name", axis.name}, {"values", axis.values}});
    Json json = {{"format", format},
                 {"program", job.program},
                 {"kind", name_of(job.kind)},
                 {"command", job.words},
                 {"result", job.result},
                 {"tasks", job.tasks},
                 {"task_seconds", job.task_seconds},
                 {"task_bytes", job.task_bytes},
                 {"files", files}};
    if (job.kind == JobKind::tiles) json["tile"] = {job.tile.width, job.tile.height};
    if (job.fit) json["fit"] = json_of(*job.fit);
    if (!job.framing.empty()) {
        json["sources"] = job.sources;
        json["framing"] = Json::parse(job.framing);
    }
    if (!axes.empty()) json["axes"] = axes;
    return json;
}

Job job_from(const Json& json) {
    Job job;
    job.program = json.at("program");
    const std::string kind = json.at("kind");
    for (const JobKind known : {JobKind::tiles, JobKind::frames, JobKind::sweep})
        if (kind == name_of(known)) job.kind = known;
    job.words = json.at("command").get<std::vector<std::string>>();
    job.result = json.at("result");
    job.tasks = json.at("tasks");
    job.task_seconds = json.at("task_seconds");
    job.task_bytes = json.at("task_bytes");
    for (const Json& file : json.at("files"))
        job.files.push_back({file.at("name"), file.at("digest")});
    if (json.contains("tile")) job.tile = {json["tile"].at(0), json["tile"].at(1)};
    if (json.contains("fit")) job.fit = fit_from(json["fit"]);
    if (json.contains("framing")) {
        job.sources = json.at("sources");
        job.framing = json["framing"].dump();
    }
    if (json.contains("axes"))
        for (const Json& axis : json["axes"])
            job.axes.push_back({axis.at("name"), axis.at("values").get<std::vector<std::string>>()});
    return job;
}

/// Whether the numbers of a manifest fit together, whoever wrote it.
bool is_sound(const Job& job) {
    if (job.tasks < 1 || job.tasks > most_tasks || job.words.size() < 2) return false;
    if (job.kind == JobKind::sweep) return job.tasks == point_count(job.axes);
    if (job.kind == JobKind::frames) return !job.framing.empty();
    if (!job.fit || job.tile.width < 1 || job.tile.height < 1) return false;
    const ImageSize size = job.fit->size;
    const Sampling& sampling = job.fit->sampling;
    if (size.width < 1 || size.height < 1 || sampling.block < 1 || sampling.antialias.value_or(1) < 1 ||
        sampling.antialias.value_or(1) > 9)
        return false;
    const auto rows =
        (static_cast<std::uint64_t>(size.height) + static_cast<std::uint64_t>(job.tile.height) - 1) /
        static_cast<std::uint64_t>(job.tile.height);
    return job.tasks == rows * job.tile_columns();
}

} // namespace

std::string_view name_of(JobKind kind) {
    switch (kind) {
    case JobKind::tiles:
        return "tiles";
    case JobKind::frames:
        return "frames";
    case JobKind::sweep:
        return "sweep";
    }
    return "";
}

std::uint64_t Job::tile_columns() const {
    return static_cast<std::uint64_t>((fit->size.width + tile.width - 1) / tile.width);
}

Tile Job::tile_of(std::uint64_t task) const {
    const int x = static_cast<int>((task - 1) % tile_columns()) * tile.width;
    const int y = static_cast<int>((task - 1) / tile_columns()) * tile.height;
    return {x, y, std::min(tile.width, fit->size.width - x), std::min(tile.height, fit->size.height - y)};
}

std::string JobFolder::numbered(std::uint64_t task, std::string_view ending) const {
    return fmt::format("{}/{:06}{}", tasks(), task, ending);
}

std::string JobFolder::record(std::uint64_t task) const {
    return numbered(task, ".json");
}

std::string JobFolder::starts(std::uint64_t task) const {
    return numbered(task, ".starts");
}

std::string JobFolder::log(std::uint64_t task) const {
    return numbered(task, ".log");
}

std::string JobFolder::result(const Job& job) const {
    return (std::filesystem::path(path_) / job.result).string();
}

std::string JobFolder::part(const Job& job, std::uint64_t task) const {
    if (job.kind == JobKind::frames) return FrameStore(parts(), job.tasks).path(task - 1);
    return fmt::format("{}/{}_{:06}{}", parts(), job.kind == JobKind::tiles ? "tile" : "picture", task,
                       is_exr_name(job.result) ? ".exr" : ".png");
}

Status JobFolder::write(const Job& job) const {
    return write_text(manifest(), json_of(job).dump(1) + "\n");
}

Status JobFolder::read(Job& job) const {
    std::error_code error;
    if (!std::filesystem::exists(manifest(), error))
        return Status::failure(
            fmt::format("'{}' holds no job: 'graftal farm plan MODEL -o {}' makes one", path_, path_));
    std::string text;
    if (Status status = read_text(manifest(), text, most_manifest_bytes); !status.ok()) return status;
    try {
        const Json json = Json::parse(text);
        if (json.at("format") != format)
            return Status::failure(
                fmt::format("'{}' is of another version of graftal; plan the job again", manifest()));
        job = job_from(json);
    } catch (const Json::exception& fault) {
        return Status::failure(fmt::format("'{}' is damaged: {}", manifest(), fault.what()));
    }
    if (!is_sound(job)) return Status::failure(fmt::format("'{}' contradicts itself", manifest()));
    return {};
}

std::string file_digest(const std::string& path) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file) return {};
    Digest digest;
    std::array<char, 1 << 16> piece;
    std::size_t count = 0;
    while ((count = std::fread(piece.data(), 1, piece.size(), file.get())) > 0)
        digest.add(std::string_view(piece.data(), count));
    return std::ferror(file.get()) ? std::string() : digest.text();
}

std::string program_identity(const std::string& version) {
    return "graftal " + version + " " + file_digest("/proc/self/exe");
}

} // namespace graftal
