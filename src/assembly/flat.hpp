#pragma once

/// Makes one flat piece of a function: the small functions of kinematics and laws are many, and calls among
/// them pass everything through memory. It takes the compiler long, and under sanitizers hundreds of
/// megabytes, so it is for what runs over all contacts at every step, and there for contacts of balls.
#ifdef __SANITIZE_ADDRESS__
#define EIGENGRAIN_FLAT
#else
#define EIGENGRAIN_FLAT __attribute__((flatten))
#endif
