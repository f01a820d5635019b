#include <algorithm>
#include <charconv>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "compiler/lower/language.h"
#include "compiler/lower/lowering.h"
#include "compiler/primitives/mesh_file.h"
#include "compiler/support/check.h"
#include "compiler/support/path_text.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

constexpr std::size_t max_use_depth = 32;
constexpr std::size_t max_uses = 1000;

/// Points at each `use` on the way from the root model, the nearest first.
void add_chain(Diagnostic& error, const Lowering& lowering) {
    for (auto file = lowering.loading.rbegin(); file != lowering.loading.rend(); ++file)
        if (file->use_span.known()) error.with_note(file->use_span, "used from here");
}

std::string path_named_at(Span use_span, std::string_view path, const SourceMap& sources) {
    return path_beside(sources.name(use_span.file), path);
}

bool check_path(Span use_span, std::string_view path, Lowering& lowering) {
    const bool printable =
        std::none_of(path.begin(), path.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    if (printable && !path.empty()) return true;
    lowering.diagnostics.error(use_span, "this is not the name of a file");
    return false;
}

bool check_chain(Span use_span, const std::string& path, Lowering& lowering) {
    const std::vector<LoadingFile>& loading = lowering.loading;
    const auto again = std::find_if(loading.begin(), loading.end(),
                                    [&](const LoadingFile& file) { return file.path == path; });
    if (again != loading.end()) {
        std::string cycle;
        for (auto file = again; file != loading.end(); ++file)
            cycle += file->path + " -> ";
        add_chain(
            lowering.diagnostics.error(use_span, fmt::format("'{}' uses itself: {}{}", path, cycle, path)),
            lowering);
        return false;
    }
    if (loading.size() > max_use_depth) {
        lowering.diagnostics.error(use_span, fmt::format("models are used more than {} deep", max_use_depth));
        return false;
    }
    return true;
}

bool leads_out(const std::string& path, const Lowering& lowering) {
    const std::string& root = lowering.options.root;
    return !root.empty() && !lowering.help.files->lies_in(path, root);
}

Status check_regular(const std::string& path, const Lowering& lowering) {
    // Asked first: of files outside nobody learns whether they are there.
    if (leads_out(path, lowering))
        return Status::failure(
            fmt::format("'{}' leads out of the root folder '{}'", path, lowering.options.root));
    return lowering.help.files->check(path);
}

/// The hint for a file that is not there, or may not be read.
std::string missing_hint(const Status& status, const std::string& path, const Lowering& lowering) {
    if (leads_out(path, lowering))
        return "start 'graftal studio' in a folder above both files, or name such a folder with --root";
    return status.message().starts_with("cannot open")
               ? "paths begin in the folder of the file that names them: put it there, or write the way to it"
               : "";
}

/// A regular file, read once.
std::optional<FileId> read_file(Span use_span, const std::string& path, Lowering& lowering) {
    if (const auto known = lowering.files.find(path); known != lowering.files.end()) return known->second;
    std::string text;
    Status read = check_regular(path, lowering);
    if (read.ok()) read = lowering.help.files->read(path, text);
    if (read.ok())
        return lowering.files[path] =
                   lowering.sources.add(path, lowering.help.translator.model_text(path, std::move(text)));
    add_chain(
        lowering.diagnostics.error(use_span, read.message()).with_hint(missing_hint(read, path, lowering)),
        lowering);
    return std::nullopt;
}

/// The text of a used file in one of our languages.
std::optional<FileId> read_used(Span use_span, const std::string& path, Lowering& lowering) {
    if (const auto known = lowering.own_texts.find(path); known != lowering.own_texts.end()) {
        if (!known->second) ++lowering.known_failures;
        return known->second;
    }
    const Translator& translator = lowering.help.translator;
    const ModelPath parts = translator.model_path(path);
    std::optional<FileId> file = read_file(use_span, parts.file, lowering);
    if (file)
        file = translator.own_text(
            *file, parts.model, lowering.sources, lowering.diagnostics,
            {lowering.options.root, lowering.help.files, lowering.options.seed.value_or(0)}, &lowering.meter);
    if (file && lowering.sources.original(*file)) lowering.notes.asks_chance = true; // translators choose
    return lowering.own_texts[path] = file;
}

/// Warnings about the members of one family are said once.
std::shared_ptr<const Graph> lower_used(FileId file, const LoadingFile& loading, Lowering& lowering) {
    const std::size_t known = lowering.diagnostics.all().size();
    std::shared_ptr<const Graph> result;
    const std::size_t failures = lowering.failures();
    lowering.loading.push_back(loading);
    if (std::optional<Graph> graph = lower_file(file, loading.use_span, lowering))
        result = std::make_shared<const Graph>(std::move(*graph));
    lowering.loading.pop_back();
    GRAFTAL_CHECK(result || lowering.failures() > failures, "lower: " + loading.path);
    if (!loading.inner.empty() || loading.part) lowering.diagnostics.drop_repeated_remarks(known);
    return result;
}

std::shared_ptr<const Graph> load(const UseStatement& use, const Environment& inner,
                                  const std::optional<PartCall>& part, Lowering& lowering) {
    const std::string path = path_named_at(use.path_span, use.path, lowering.sources);
    if (!check_chain(use.path_span, path, lowering)) return nullptr;
    const LoweredKey key{path, inner, part};
    const auto known = lowering.lowered.find(key);
    if (known != lowering.lowered.end()) {
        if (!known->second) ++lowering.known_failures;
        return known->second;
    }
    std::shared_ptr<const Graph> result;
    if (const std::optional<FileId> file = read_used(use.path_span, path, lowering))
        result = lower_used(*file, {path, use.path_span, inner, part}, lowering);
    lowering.lowered[key] = result;
    return result;
}

/// Ids of `into` for the materials of `from`, in order. `prefixed`: names that are free are not taken either,
/// since parts of `into` that come later may mean another material by them.
std::vector<MaterialId> append_materials(Graph& into, const Graph& from, std::string_view prefix,
                                         bool prefixed) {
    std::unordered_map<std::string, MaterialId> known;
    for (MaterialId id = 0; id < into.materials.size(); ++id)
        known.emplace(into.materials[id].name, id);
    std::vector<MaterialId> ids;
    for (Material material : from.materials) {
        const std::string name = material.name;
        const auto taken = [&] {
            const auto same = known.find(material.name);
            return same != known.end() && into.materials[same->second] != material;
        };
        if (taken() || (prefixed && !known.contains(name)))
            material.name = fmt::format("{}.{}", prefix, name);
        for (int i = 2; taken(); ++i)
            material.name = fmt::format("{}.{}_{}", prefix, name, i);
        const auto [place, fresh] =
            known.emplace(material.name, static_cast<MaterialId>(into.materials.size()));
        ids.push_back(place->second);
        if (fresh) into.materials.push_back(std::move(material));
    }
    return ids;
}

constexpr ObjectId no_object = UINT32_MAX;

/// Ids of `into` for the primitives of `from`; no_object for those that it does not have yet.
std::unordered_map<Primitive, ObjectId> primitives_of(const Graph& from, const Graph& into) {
    std::unordered_map<Primitive, ObjectId> ids;
    for (const Object& object : from.objects)
        if (object.primitive) ids.emplace(*object.primitive, no_object);
    std::size_t missing = ids.size();
    for (ObjectId id = 0; id < into.objects.size() && missing > 0; ++id) {
        if (!into.objects[id].primitive) continue;
        const auto wanted = ids.find(*into.objects[id].primitive);
        if (wanted == ids.end() || wanted->second != no_object) continue;
        wanted->second = id;
        --missing;
    }
    return ids;
}

/// `known`: objects of `into` that may stand for those of `from` that would have their names.
ObjectId append_objects(Graph& into, const Graph& from, std::string_view prefix,
                        const std::vector<MaterialId>& materials,
                        const std::unordered_map<std::string, ObjectId>& known) {
    const std::size_t before = into.objects.size();
    std::unordered_map<Primitive, ObjectId> primitives = primitives_of(from, into);
    std::vector<ObjectId> ids;
    for (const Object& object : from.objects) {
        if (object.primitive) {
            ObjectId& id = primitives[*object.primitive];
            if (id == no_object) id = into.add(object);
            ids.push_back(id);
            continue;
        }
        std::string name = fmt::format("{}.{}", prefix, object.name);
        if (const auto same = known.find(name); same != known.end()) {
            ids.push_back(same->second);
            continue;
        }
        Object copy = object;
        copy.name = std::move(name);
        ids.push_back(into.add(std::move(copy)));
    }
    const auto translate = [&](Instance& instance) {
        instance.master = ids[instance.master];
        if (instance.material) instance.material = materials[*instance.material];
    };
    for (std::size_t i = 0; i < ids.size(); ++i) {
        if (from.objects[i].primitive || ids[i] < before) continue;
        Object& object = into.objects[ids[i]];
        for (Instance& instance : object.instances)
            translate(instance);
        if (object.terminal) translate(*object.terminal);
        for (std::optional<MaterialId>& material : object.packed.materials)
            if (material) material = materials[*material];
    }
    return ids[from.root];
}

/// `leaf.k3`, if no object's name begins so, nor with `leaf.k4` and so on.
std::string free_prefix(const Graph& graph, std::string_view name) {
    const std::string stem = fmt::format("{}.k", name);
    unsigned last = 0;
    for (const Object& object : graph.objects) {
        if (!object.name.starts_with(stem)) continue;
        const char* const begin = object.name.data() + stem.size();
        unsigned number = 0;
        if (std::from_chars(begin, object.name.data() + object.name.size(), number).ec == std::errc())
            last = std::max(last, number);
    }
    return fmt::format("{}{}", stem, last + 1);
}

/// Appends what load() gave; nothing where it gave none, or there is no room. A member of a family has a
/// prefix of its own. `known`: see append_objects().
std::optional<ObjectId> append(Graph& into, const std::shared_ptr<const Graph>& model,
                               const UseStatement& use, bool is_member,
                               const std::unordered_map<std::string, ObjectId>& known, Lowering& lowering) {
    if (!model || !within_limits(into.objects.size() + model->objects.size(),
                                 instance_count(into) + instance_count(*model), use.path_span, lowering))
        return std::nullopt;
    lowering.meter.add(model->objects.size(), StagePrice::copied_object);
    lowering.meter.add(instance_count(*model), StagePrice::copied_instance);
    const std::string name(use.name.text);
    return append_objects(into, *model, is_member ? free_prefix(into, name) : name,
                          append_materials(into, *model, name, is_member), known);
}

} // namespace

std::optional<std::string> find_beside(Span name_span, std::string_view path, Lowering& lowering) {
    if (!check_path(name_span, path, lowering)) return std::nullopt;
    std::string found = path_named_at(name_span, path, lowering.sources);
    const Status regular = check_regular(found, lowering);
    if (regular.ok()) return found;
    add_chain(lowering.diagnostics.error(name_span, regular.message())
                  .with_hint(missing_hint(regular, found, lowering)),
              lowering);
    return std::nullopt;
}

std::optional<Primitive> load_mesh(Span name_span, std::string_view path, Lowering& lowering) {
    const std::optional<std::string> found = find_beside(name_span, path, lowering);
    if (!found) return std::nullopt;
    const auto [known, added] = lowering.meshes.try_emplace(*found);
    if (!added) {
        if (!known->second) ++lowering.known_failures;
        return known->second;
    }
    lowering.notes.meshes[*found] = lowering.help.files->stamp(*found);
    std::string bytes, fault;
    if (const Status read = lowering.help.files->read(*found, bytes); !read.ok()) {
        add_chain(lowering.diagnostics.error(name_span, read.message()), lowering);
        return std::nullopt;
    }
    std::optional<MeshData> data = read_mesh(bytes, fault);
    if (data) return known->second = mesh_primitive(*found, std::move(*data));
    add_chain(lowering.diagnostics.error(name_span, fmt::format("cannot read '{}': {}", *found, fault))
                  .with_hint("a mesh is an OBJ, a PLY or an STL file"),
              lowering);
    return std::nullopt;
}

bool within_limits(std::size_t objects, std::size_t instances, Span span, Lowering& lowering) {
    const std::size_t most_objects = lowering.options.max_objects;
    const std::size_t most_instances = most_objects * max_instances_per_object;
    // Later objects need not be made, if those made so far take too much already.
    if (work_of_graph(objects, instances) > lowering.meter.left_in_all())
        throw OutOfWork("lower", lowering.help.control.work->limit());
    if (objects <= most_objects && instances <= most_instances) return true;
    lowering.diagnostics.error(
        span, objects > most_objects ? fmt::format("the model has more than {} objects", most_objects)
                                     : fmt::format("the model has more than {} instances", most_instances));
    return false;
}

bool leaves_out_colours(std::size_t objects, std::size_t instances, double work_left, Span place,
                        Lowering& lowering) {
    if (!lowering.options.may_leave_out_colours) return false;
    const double copies = StagePrice::copied_object * static_cast<double>(objects) +
                          StagePrice::copied_instance * static_cast<double>(instances);
    if (copies + work_of_graph(objects, instances) <= work_left) return false;
    lowering.notes.limited_by_work = true;
    lowering.diagnostics.note(
        place, "graftal leaves the hues and inks out here, since their many objects take more work than "
               "--work allows: they change no shape, no bound and no count of leaves");
    return true;
}

std::optional<FileId> read_model(const UseStatement& use, Lowering& lowering) {
    if (!check_path(use.path_span, use.path, lowering)) return std::nullopt;
    if (++lowering.use_count > max_uses) {
        lowering.diagnostics.error(use.path_span, fmt::format("the model has more than {} uses", max_uses));
        return std::nullopt;
    }
    return read_used(use.path_span, path_named_at(use.path_span, use.path, lowering.sources), lowering);
}

std::optional<ObjectId> import_model(Graph& into, const UseStatement& use, Lowering& lowering) {
    return append(into, load(use, {}, {}, lowering), use, false, {}, lowering);
}

std::optional<ObjectId> import_member(Graph& into, const UseStatement& use, const Environment& inner,
                                      Lowering& lowering) {
    return append(into, load(use, inner, {}, lowering), use, true, {}, lowering);
}

std::optional<ObjectId> import_part(Graph& into, const std::unordered_map<std::string, ObjectId>& known,
                                    const UseStatement& use, const PartCall& part, Lowering& lowering) {
    // A model of another program has parts where its translation is in a language that has.
    const std::optional<FileId> file =
        read_used(use.path_span, path_named_at(use.path_span, use.path, lowering.sources), lowering);
    const Language* const language =
        file ? language_of(*file, lowering.sources, lowering.languages) : nullptr;
    lowering.part_missing = !language || language->extension != "inst";
    if (lowering.part_missing) return std::nullopt;
    return append(into, load(use, {}, part, lowering), use, false, known, lowering);
}

} // namespace graftal
