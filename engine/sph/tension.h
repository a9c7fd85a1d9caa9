/* The artificial stress of Monaghan 2000 (J. Comput. Phys. 159, 290) in the principal axes of the stress, as in Gray,
 * Monaghan & Swift 2001: R = -epsilon times the tensile part of sigma/rho^2. It repels particles that a tension would pull into
 * clumps. */
#ifndef CLAST_ENGINE_SPH_TENSION_H
#define CLAST_ENGINE_SPH_TENSION_H

/* Symmetric tensors as xx xy xz yy yz zz. */
void sph_tension_opposed(double epsilon, const double stress[6], double artificial[6]);

#endif
