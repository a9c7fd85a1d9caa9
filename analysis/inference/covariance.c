/* Cholesky factors and eigenvectors. */
#include "analysis/inference/inference.h"

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

static void forward(size_t n, const double *factor, const double *b, double *x) {
  for (size_t i = 0; i < n; i++) {
    double sum = b[i];
    for (size_t j = 0; j < i; j++)
      sum -= factor[i * n + j] * x[j];
    x[i] = sum / factor[i * n + i];
  }
}

void covariance_solve(size_t n, const double *factor, const double *b, double *x) {
  forward(n, factor, b, x);
  for (size_t i = n; i-- > 0;) {
    double sum = x[i];
    for (size_t j = i + 1; j < n; j++)
      sum -= factor[j * n + i] * x[j];
    x[i] = sum / factor[i * n + i];
  }
}

double covariance_distance(size_t n, const double *factor, const double *b, double *half) {
  double sum = 0;
  forward(n, factor, b, half);
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
