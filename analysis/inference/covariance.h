/* Cholesky factors of covariance matrices, row-major arrays of n x n, by GSL. */
#ifndef CLAST_ANALYSIS_INFERENCE_COVARIANCE_H
#define CLAST_ANALYSIS_INFERENCE_COVARIANCE_H

#include <stdbool.h>
#include <stddef.h>

/* Writes the lower factor L into the lower triangle of *matrix; elements above the diagonal do not change. False: the
 * matrix is not positive definite. Call analysis_init() first. */
bool covariance_factor(size_t n, double *matrix);
/* The logarithm of the determinant of L L^T. */
double covariance_log_determinant(size_t n, const double *factor);
/* x = (L L^T)^-1 b; x may be b. */
void covariance_solve(size_t n, const double *factor, const double *b, double *x);
/* Returns b^T (L L^T)^-1 b. `half` is an array of n; it receives L^-1 b. */
double covariance_distance(size_t n, const double *factor, const double *b, double *half);
/* Writes the whole inverse of L L^T into *inverse, n x n. */
void covariance_inverse(size_t n, const double *factor, double *inverse);
/* Eigenvalues in descending order, and the eigenvectors as rows, of a symmetric matrix of at most COVARIANCE_MOST rows.
 */
enum { COVARIANCE_MOST = 32 };
void covariance_eigen(size_t n, const double *matrix, double *values, double *vectors);

#endif
