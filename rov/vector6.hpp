// The six-vectors of engine/core under the vehicle's names.
#pragma once

#include "engine/core/vector6.hpp"

namespace neritic::rov {

using neritic::diagonal;
using neritic::dot;
using neritic::inverse;
using neritic::is_finite;
using neritic::Mat6;
using neritic::set_cross;
using neritic::smallest_pivot;
using neritic::solve;
using neritic::symmetric_part;
using neritic::transpose;
using neritic::Vec6;
using neritic::vec6;

}  // namespace neritic::rov
