/* Beads hit a plate, in time steps of velocity Verlet with the contact force of the law.
 *
 *     contactlaw export header --sphere gamma-alumina --plate glass --out contactlaw.h
 *     cc -O2 soft_sphere.c -o soft_sphere -lm && ./soft_sphere
 */
#include "contactlaw.h"
#include <stdio.h>

#define BEADS 5
#define GRAVITY 9.81 /* [m/s2] */

int main(void)
{
    const double radius = 0.9e-3, thickness = 1e-3, fastest = 10.0; /* [m, m, m/s] */
    const double dt = contactlaw_rebound(fastest, radius, thickness).contact_time / 50.0;
    const contactlaw_spring spring = contactlaw_spring_of(radius, thickness);
    double height[BEADS], speed[BEADS], peak[BEADS] = { 0.0 }; /* of lowest points; speeds down */
    contactlaw_state state[BEADS] = { CONTACTLAW_APART };      /* the other elements are zero too */
    int n, step;

    for (n = 0; n < BEADS; ++n) {
        height[n] = 1e-5;
        speed[n] = fastest * (n + 1) / BEADS;
    }
    for (step = 0; step < 500; ++step)
        for (n = 0; n < BEADS; ++n) {
            speed[n] += 0.5 * dt * (GRAVITY - state[n].force / spring.mass);
            height[n] -= dt * speed[n];
            contactlaw_step(&spring, &state[n], -height[n], dt);
            speed[n] += 0.5 * dt * (GRAVITY - state[n].force / spring.mass);
            if (state[n].force > peak[n])
                peak[n] = state[n].force;
        }
    for (n = 0; n < BEADS; ++n)
        printf("hit at %4.1f m/s: %.6f N at most, back at %.9f m/s\n",
               fastest * (n + 1) / BEADS, peak[n], -speed[n]);
    return 0;
}
