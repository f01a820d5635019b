#include <nlohmann/json.hpp>

#include "compiler/session/shared_framing.h"

namespace graftal {

namespace {

using Json = nlohmann::ordered_json;

Json triple(const Vec3& v) {
    return Json::array({v.x, v.y, v.z});
}

Vec3 triple_from(const Json& json) {
    return {json.at(0), json.at(1), json.at(2)};
}

Json triples(const std::vector<Vec3>& vectors) {
    Json json = Json::array();
    for (const Vec3& vector : vectors)
        json.push_back(triple(vector));
    return json;
}

std::vector<Vec3> triples_from(const Json& json) {
    std::vector<Vec3> vectors;
    for (const Json& vector : json)
        vectors.push_back(triple_from(vector));
    return vectors;
}

} // namespace

// Numbers are written with as many digits as bring back the same bits.
std::string SharedFraming::json() const {
    const Json first = {{"location", triple(first_.location)},
                        {"direction", triple(first_.direction)},
                        {"up", triple(first_.up)},
                        {"right", triple(first_.right)},
                        {"orthographic", first_.orthographic},
                        {"angle_deg", first_.angle_deg},
                        {"width", first_.width}};
    return Json({{"size", {size_.width, size_.height}},
                 {"turning", turning_},
                 {"min", triple(bounds_.min)},
                 {"max", triple(bounds_.max)},
                 {"outline", triples(outline_)},
                 {"colours", triples(colours_)},
                 {"first", first}})
        .dump();
}

std::shared_ptr<const SharedFraming> SharedFraming::from_json(const std::string& text) {
    try {
        const Json json = Json::parse(text);
        auto framing = std::make_shared<SharedFraming>();
        framing->size_ = {json.at("size").at(0), json.at("size").at(1)};
        framing->turning_ = json.at("turning");
        framing->bounds_ = {triple_from(json.at("min")), triple_from(json.at("max"))};
        framing->outline_ = triples_from(json.at("outline"));
        framing->colours_ = triples_from(json.at("colours"));
        const Json& first = json.at("first");
        framing->first_ = {.location = triple_from(first.at("location")),
                           .direction = triple_from(first.at("direction")),
                           .up = triple_from(first.at("up")),
                           .right = triple_from(first.at("right")),
                           .orthographic = first.at("orthographic"),
                           .angle_deg = first.at("angle_deg"),
                           .width = first.at("width")};
        return framing;
    } catch (const Json::exception&) {
        return nullptr;
    }
}

} // namespace graftal
