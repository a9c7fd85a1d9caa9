#include <stdio.h>

#include "schemas/status.h"

int main(void) {
  puts("clast");
  return STATUS_OK;
}
