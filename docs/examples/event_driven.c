/* A bead bounces on plates, event by event: every impact has its own COR.
 *
 *     contactlaw export header --sphere gamma-alumina --plate glass --out contactlaw.h
 *     cc -O2 event_driven.c -o event_driven -lm && ./event_driven
 */
#include "contactlaw.h"
#include <stdio.h>

#define GRAVITY 9.81 /* [m/s2] */

int main(void)
{
    const double radius = 0.9e-3, height = 0.5; /* [m] */
    const double thickness[] = { 0.5e-3, 1e-3, 3e-3, INFINITY };
    int plate, bounce;

    for (plate = 0; plate < 4; ++plate) {
        double speed = sqrt(2.0 * GRAVITY * height), time = speed / GRAVITY;
        printf("plate %.1f mm:", 1e3 * thickness[plate]);
        for (bounce = 0; bounce < 5; ++bounce) {
            const double e = contactlaw_restitution(speed, radius, thickness[plate]);
            if (!(e == e)) { /* NaN: outside the table, or bad input */
                fprintf(stderr, "no answer at %g m/s\n", speed);
                return 1;
            }
            speed *= e;
            time += 2.0 * speed / GRAVITY; /* time of the next impact */
            printf(" %.9f", e);
        }
        printf(", %.9f m/s after %.9f s\n", speed, time);
    }
    return 0;
}
