/* Functions whose mutants are known. */
int toy_in_range(int x, int low, int high);
double toy_mean(const double *x, int n);
int toy_larger(int a, int b);
int toy_in_child(int x);
int toy_untested(int x);
