// Notes about broken glTF rules that the model does not depend on, since a file that is
// wrong in one place may be wrong in another. Values that a model needs are checked where they are
// read, and refused.
#pragma once

#include <set>
#include <string>

#include "engine/scene/gltf_stages.hpp"

namespace neritic::scene::gltf {

// Checks of the JSON alone: references, sizes, strides and alignment, members that exclude or need
// one another, empty lists, extensions in the wrong place or not declared. Takes any document;
// notes into the report. Returns the elements of the file's lists that something was said of, as
// "accessors[3]".
std::set<std::string> note_broken_rules(const Json& document, Report& report);

// Checks of values, once the model is whole: bounds that accessors do not keep, accessors and
// pictures that nothing is drawn with and that cannot be read, indices that would restart a
// primitive, inverse bind matrices, joints beside the shown scene. Skips elements in `told`, which
// have a note already.
void note_broken_values(Loading& loading, const std::set<std::string>& told);

}  // namespace neritic::scene::gltf
