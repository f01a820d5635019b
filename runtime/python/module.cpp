// The Python module graftal._graftal: the library's public face (graftal/model.h) for
// graftal/__init__.py, which has the documentation.

#include <array>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <graftal/model.h>

namespace py = pybind11;
using namespace graftal::v1;

namespace {

/// A message with the library's functions written as the keywords of graftal/__init__.py: "steps(5)" as
/// "steps=5", "memory()" as "memory_bytes=".
std::string in_python_words(const std::string& message) {
    static const std::regex memory("\\bmemory\\("), work("\\bwork\\(");
    static const std::regex call(
        "\\b(engine|error_px|instancing|levels|memory_bytes|most_bytes|nodes|quality|seed|size|steps|work_s)"
        "\\(([^()]*)\\)");
    const std::string renamed =
        std::regex_replace(std::regex_replace(message, memory, "memory_bytes("), work, "work_s(");
    return std::regex_replace(renamed, call, "$1=$2");
}

/// The exception of graftal/__init__.py, which carries the messages.
[[noreturn]] void raise_error(const std::vector<Message>& messages, bool cancelled) {
    py::object error = py::module_::import("graftal").attr(cancelled ? "Cancelled" : "ModelError");
    PyErr_SetObject(error.ptr(), error(in_python_words(text_of(messages)), messages).ptr());
    throw py::error_already_set();
}

/// Warnings become Python's, each a graftal.ModelWarning.
void warn(const std::vector<Message>& messages) {
    for (const Message& message : messages) {
        if (message.severity != Severity::warning) continue;
        std::string text = in_python_words(text_of({message}));
        text.pop_back(); // the end of its last line
        const py::object category = py::module_::import("graftal").attr("ModelWarning");
        if (PyErr_WarnEx(category.ptr(), text.c_str(), 2) != 0) throw py::error_already_set();
    }
}

/// Runs without Python's lock. Ctrl-C, and what `progress` throws, end it.
template<typename Work> auto value_of(Model& model, const py::object& progress, const Work& work) {
    std::exception_ptr thrown; // perhaps in another thread than this
    model.on_progress([&](std::string_view stage, std::optional<double> share) {
        const py::gil_scoped_acquire lock;
        if (thrown) return;
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            if (!progress.is_none()) progress(std::string(stage), share);
        } catch (const py::error_already_set&) {
            thrown = std::current_exception();
            model.cancel();
        }
    });
    auto result = [&] {
        const py::gil_scoped_release unlock;
        return work();
    }();
    model.on_progress({});
    if (thrown) std::rethrow_exception(thrown);
    if (!result) raise_error(result.messages, result.cancelled);
    warn(result.messages);
    return std::move(*result.value);
}

/// An array that owns what a vector had.
template<typename Value>
py::array_t<Value> array_of(std::vector<Value> values, std::vector<py::ssize_t> shape) {
    auto owner = std::make_unique<std::vector<Value>>(std::move(values));
    Value* const data = owner->data();
    const py::capsule capsule(owner.release(),
                              [](void* held) { delete static_cast<std::vector<Value>*>(held); });
    return py::array_t<Value>(std::move(shape), data, capsule);
}

py::dict graph_of(const ObjectGraph& graph) {
    const auto count = static_cast<py::ssize_t>(graph.instances.size());
    py::array_t<std::int64_t> parents(count), children(count);
    py::array_t<double> maps({count, py::ssize_t{3}, py::ssize_t{4}}), tints({count, py::ssize_t{4}});
    for (py::ssize_t i = 0; i < count; ++i) {
        const GraphInstance& instance = graph.instances[static_cast<std::size_t>(i)];
        parents.mutable_at(i) = static_cast<std::int64_t>(instance.parent);
        children.mutable_at(i) = static_cast<std::int64_t>(instance.child);
        std::memcpy(maps.mutable_data(i), instance.parent_from_child, sizeof instance.parent_from_child);
        std::memcpy(tints.mutable_data(i), instance.tint, sizeof instance.tint);
    }
    py::dict dict;
    dict["root"] = graph.root;
    dict["objects"] = graph.objects;
    dict["primitives"] = graph.primitives;
    dict["parents"] = parents;
    dict["children"] = children;
    dict["parent_from_child"] = maps;
    dict["tints"] = tints;
    return dict;
}

std::optional<Vector> vector_of(const std::optional<std::array<double, 3>>& v) {
    return v ? std::optional(Vector{(*v)[0], (*v)[1], (*v)[2]}) : std::nullopt;
}

} // namespace

PYBIND11_MODULE(_graftal, module) {
    py::class_<Message>(module, "Message")
        .def_property_readonly("severity", [](const Message& message) { return name_of(message.severity); })
        .def_readonly("file", &Message::file)
        .def_readonly("line", &Message::line)
        .def_readonly("column", &Message::column)
        .def_property_readonly("text", [](const Message& message) { return in_python_words(message.text); })
        .def_property_readonly("hint", [](const Message& message) { return in_python_words(message.hint); })
        .def("__repr__", [](const Message& message) { return in_python_words(text_of({message})); });

    module.attr("version") = GRAFTAL_VERSION;

    py::class_<Model>(module, "Model")
        .def_static("from_file", &Model::from_file)
        .def_static("from_text", &Model::from_text)
        .def("reload", &Model::reload)
        .def("edit", &Model::edit)
        .def("set", &Model::set)
        .def("unset", &Model::unset)
        .def("steps", &Model::steps)
        .def("time", &Model::time)
        .def("seed", &Model::seed)
        .def("size", &Model::size)
        .def("zoom", &Model::zoom)
        .def("error_px", &Model::error_px)
        .def("memory", &Model::memory)
        .def("work", &Model::work)
        .def("threads", &Model::threads)
        .def("antialias", &Model::antialias)
        .def("root", &Model::root)
        .def("cancel", &Model::cancel)
        .def("quality",
             [](Model& model, const std::string& name) {
                 model.quality(name == "draft"  ? Quality::draft
                               : name == "best" ? Quality::best
                                                : Quality::normal);
             })
        .def("camera",
             [](Model& model, const std::optional<std::array<double, 3>>& location,
                const std::optional<std::array<double, 3>>& look_at,
                const std::optional<std::array<double, 3>>& up, std::optional<double> angle_deg,
                bool orthographic, std::optional<double> width) {
                 model.camera({vector_of(location), vector_of(look_at), vector_of(up), angle_deg,
                               orthographic, width});
             })
        .def(
            "lens",
            [](Model& model, std::optional<double> aperture,
               const std::optional<std::array<double, 3>>& focus) { model.lens(aperture, vector_of(focus)); })
        .def("stats",
             [](Model& model, const py::object& progress) {
                 return value_of(model, progress, [&] { return model.stats(); }).json;
             })
        .def("graph",
             [](Model& model, const py::object& progress) {
                 return graph_of(value_of(model, progress, [&] { return model.graph(); }));
             })
        .def("word",
             [](Model& model, const py::object& progress) {
                 return value_of(model, progress, [&] { return model.word(); });
             })
        .def("plant",
             [](Model& model, const py::object& progress) {
                 PlantTable table = value_of(model, progress, [&] { return model.plant(); });
                 const auto rows = static_cast<py::ssize_t>(table.names.size()),
                            parameters = static_cast<py::ssize_t>(table.parameter_count);
                 py::dict dict;
                 dict["name"] = table.names;
                 dict["branches"] = table.branches;
                 dict["parent"] = array_of(std::move(table.parents), {rows});
                 dict["order"] = array_of(std::move(table.orders), {rows});
                 dict["rank"] = array_of(std::move(table.ranks), {rows});
                 dict["part_of"] = array_of(std::move(table.parts_of), {rows});
                 dict["organ"] = table.organs;
                 dict["material"] = table.materials;
                 dict["age"] = array_of(std::move(table.ages), {rows});
                 dict["start"] = array_of(std::move(table.starts), {rows, 3});
                 dict["end"] = array_of(std::move(table.ends), {rows, 3});
                 dict["heading"] = array_of(std::move(table.headings), {rows, 3});
                 dict["left"] = array_of(std::move(table.lefts), {rows, 3});
                 dict["up"] = array_of(std::move(table.ups), {rows, 3});
                 dict["length"] = array_of(std::move(table.lengths), {rows});
                 dict["width"] = array_of(std::move(table.widths), {rows});
                 dict["area"] = array_of(std::move(table.areas), {rows});
                 dict["volume"] = array_of(std::move(table.volumes), {rows});
                 dict["parameters"] = array_of(std::move(table.parameters), {rows, parameters});
                 return dict;
             })
        .def("measures",
             [](Model& model, std::optional<double> ground_area, bool irradiance, std::optional<int> samples,
                const py::object& progress) {
                 const MeasureSettings settings{ground_area, irradiance, samples.value_or(0)};
                 PlantReport report = value_of(model, progress, [&] { return model.measures(settings); });
                 const auto rows = static_cast<py::ssize_t>(report.lights.size());
                 py::dict organs;
                 organs["irradiance"] = array_of(std::move(report.lights), {rows});
                 organs["irradiance_error"] = array_of(std::move(report.errors), {rows});
                 organs["absorbed"] = array_of(std::move(report.absorbed), {rows});
                 organs["sunlit"] = array_of(std::move(report.sunlit), {rows});
                 return py::make_tuple(report.json, organs);
             })
        .def("points",
             [](Model& model, std::uint64_t count, const py::object& progress) {
                 Points points = value_of(model, progress, [&] { return model.points(count); });
                 const auto rows = static_cast<py::ssize_t>(points.rgb.size() / 3);
                 return py::make_tuple(array_of(std::move(points.places), {rows, 3}),
                                       array_of(std::move(points.rgb), {rows, 3}));
             })
        .def("render",
             [](Model& model, const py::object& progress) {
                 Picture picture = value_of(model, progress, [&] { return model.render(); });
                 return array_of(std::move(picture.rgb), {picture.height, picture.width, 3});
             })
        .def("aovs",
             [](Model& model, const py::object& progress) {
                 Channels seen = value_of(model, progress, [&] { return model.aovs(); });
                 const auto count = static_cast<py::ssize_t>(seen.names.size());
                 return py::make_tuple(seen.names,
                                       array_of(std::move(seen.samples), {seen.height, seen.width, count}),
                                       seen.objects);
             })
        .def(
            "render_to",
            [](Model& model, const std::string& path, const std::string& engine, const py::object& progress) {
                value_of(model, progress, [&] {
                    return model.render_to(path, engine == "povray" ? Engine::povray : Engine::native);
                });
            })
        .def("compile_to",
             [](Model& model, const std::string& path, const py::object& progress) {
                 value_of(model, progress, [&] { return model.compile_to(path); });
             })
        .def("export_to", [](Model& model, const std::string& path, std::optional<double> unit_mm,
                             std::optional<unsigned> levels, std::optional<std::size_t> nodes,
                             bool instancing, bool plotter, std::uint64_t most_bytes, bool irradiance,
                             std::vector<std::string> parts, const py::object& progress) {
            const ExportSettings settings{unit_mm, levels,     nodes,      instancing,
                                          plotter, most_bytes, irradiance, std::move(parts)};
            value_of(model, progress, [&] { return model.export_to(path, settings); });
        });
}
