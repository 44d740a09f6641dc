#!/bin/sh
# Every kind of scene from every kind of start at 3,000 and 10,000 bodies, which takes hours: the long form of the tests
# Matrix/* (tests/relaxation/matrix_test.cpp). Prints what each relaxation took.
#   relax_matrix.sh [BUILD] [FILTER]     e.g. relax_matrix.sh build/release '*/Matrix.*/servo'
build=${1:-$(dirname "$0")/../../build/release}
EIGENGRAIN_LONG_TESTS=1 OMP_WAIT_POLICY=passive exec "$build/bin/test_relaxation" --gtest_filter="${2:-*Matrix*}"
