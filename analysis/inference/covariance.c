/* Cholesky factors and eigenvectors. */
#include "analysis/inference/inference.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

bool covariance_factor(size_t n, double *matrix) {
  gsl_matrix_view view = gsl_matrix_view_array(matrix, n, n);
  for (size_t i = 0; i < n * n; i++)
    if (!isfinite(matrix[i]))
      return false;
  return gsl_linalg_cholesky_decomp1(&view.matrix) == GSL_SUCCESS;
}

double covariance_log_determinant(size_t n, const double *factor) {
  double sum = 0;
  for (size_t i = 0; i < n; i++)
    sum += 2 * log(factor[i * n + i]);
  return sum;
}

void covariance_solve(size_t n, const double *factor, const double *b, double *x) {
  const gsl_matrix_const_view f = gsl_matrix_const_view_array(factor, n, n);
  const gsl_vector_const_view from = gsl_vector_const_view_array(b, n);
  gsl_vector_view to = gsl_vector_view_array(x, n);
  gsl_linalg_cholesky_solve(&f.matrix, &from.vector, &to.vector);
}

double covariance_distance(size_t n, const double *factor, const double *b, double *half) {
  const gsl_matrix_const_view f = gsl_matrix_const_view_array(factor, n, n);
  gsl_vector_view to = gsl_vector_view_array(half, n);
  double sum = 0;
  memmove(half, b, n * sizeof *half);
  gsl_blas_dtrsv(CblasLower, CblasNoTrans, CblasNonUnit, &f.matrix, &to.vector);
  for (size_t i = 0; i < n; i++)
    sum += half[i] * half[i];
  return sum;
}

void covariance_inverse(size_t n, const double *factor, double *inverse) {
  memcpy(inverse, factor, n * n * sizeof *inverse);
  gsl_matrix_view view = gsl_matrix_view_array(inverse, n, n);
  gsl_linalg_cholesky_invert(&view.matrix); /* fills both triangles */
}

void covariance_eigen(size_t n, const double *matrix, double *values, double *vectors) {
  double copy[COVARIANCE_MOST * COVARIANCE_MOST], columns[COVARIANCE_MOST * COVARIANCE_MOST];
  memcpy(copy, matrix, n * n * sizeof *copy);
  gsl_matrix_view a = gsl_matrix_view_array(copy, n, n), v = gsl_matrix_view_array(columns, n, n);
  gsl_vector_view w = gsl_vector_view_array(values, n);
  gsl_eigen_symmv_workspace *workspace = gsl_eigen_symmv_alloc(n);
  gsl_eigen_symmv(&a.matrix, &w.vector, &v.matrix, workspace);
  gsl_eigen_symmv_free(workspace);
  gsl_eigen_symmv_sort(&w.vector, &v.matrix, GSL_EIGEN_SORT_VAL_DESC);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      vectors[i * n + j] = columns[j * n + i];
}
