/* What a program does with statuses and modes: a checker for MISRA C has nothing to say about it. */
#include "holdover.h"

holdover_status_t use(void *unit, holdover_answer_t *answer);

holdover_status_t use(void *unit, holdover_answer_t *answer)
{
    holdover_status_t status = holdover_tick(unit, 0U, answer);
    if (status == HOLDOVER_OK) {
        if (answer->command.mode == HOLDOVER_MODE_STANDBY) {
            status = HOLDOVER_NOT_INITIALISED;
        }
    }
    if (status <= HOLDOVER_REFUSED_LENGTH) {
        status = holdover_note(unit, HOLDOVER_INCIDENT_OVERRUN, 1U);
    }
    return status;
}
