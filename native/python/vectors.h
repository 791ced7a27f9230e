// Small vectors and matrices between Python and GLM.
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "base/error.h"

namespace mesograin::python {

using Triple = std::array<double, 3>;
template <typename Number>
using Array = pybind11::array_t<Number, pybind11::array::c_style | pybind11::array::forcecast>;

inline glm::dvec3 to_vector(const Triple& triple) { return {triple[0], triple[1], triple[2]}; }
inline Triple to_triple(const glm::dvec3& vector) { return {vector.x, vector.y, vector.z}; }

inline glm::dmat4 to_matrix(const Array<double>& array, const char* name) {
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4) throw Error("{} must be a 4 x 4 matrix.", name);
  return glm::transpose(glm::make_mat4(array.data()));  // numpy's rows are GLM's columns
}

}  // namespace mesograin::python
