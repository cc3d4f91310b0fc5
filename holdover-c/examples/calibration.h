/* What the unit of replay.c is told. */
#ifndef CALIBRATION_H
#define CALIBRATION_H

#include "holdover.h"

/* Volatile, so that the compiler reads what is there and not what it was when it compiled. */
extern const volatile holdover_config_t calibration;

#endif
