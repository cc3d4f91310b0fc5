/* Header and library are built for one capacity: a unit of it starts by the default configuration. */
#include "holdover.h"

static uint64_t unit[HOLDOVER_UNIT_SIZE / sizeof(uint64_t)];

int main(void)
{
    holdover_config_t config;
    if (holdover_unit_size() != HOLDOVER_UNIT_SIZE) {
        return 1;
    }
    (void)holdover_default_config(&config);
    return holdover_init(unit, sizeof unit, &config) == HOLDOVER_OK ? 0 : 2;
}
