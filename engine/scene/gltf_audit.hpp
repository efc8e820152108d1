// What breaks glTF's rules where the model does not need it: said as notes, since a file that is
// wrong in one place may be wrong in another. What a model needs is checked where it is read, and
// refused.
#pragma once

#include "engine/scene/gltf_json.hpp"

namespace neritic::scene::gltf {

// Of the JSON alone: references, sizes, strides and alignment, members that exclude or need one
// another, empty lists, extensions in the wrong place or not declared. Takes any document; notes
// into the report.
void note_broken_rules(const Json& document, Report& report);

}  // namespace neritic::scene::gltf
