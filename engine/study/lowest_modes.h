// SPDX-License-Identifier: BSD-3-Clause
// The low end of K x = lambda M x, accurate although the high end is many orders above.
#pragma once

#include "engine/math/linear_solve.h"

namespace cprsim {

/// The `count` lowest eigenvalues (ascending; fewer if there are not so many) and M-orthonormal
/// vectors of symmetric K and positive semidefinite M, found from the other end:
/// M x = mu (K + shift M) x, lambda = 1 / mu - shift, with the least shift of a coarse scale that
/// makes the right side positive definite (0 where K is). Motions without inertia, mu = 0, are left
/// out. By subspace iteration (Bathe and Wilson, Proc. ICE 53, 1972): one factorisation, instead of
/// the decomposition of a full matrix, which is what small problems get.
SymmetricModes lowest_modes(const MatX& K, const MatX& M, int count);

}  // namespace cprsim
