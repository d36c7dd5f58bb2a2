/* A million beads bounce on plates, event by event: one thread each on a GPU, then one core.
 *
 *     contactlaw export header --sphere gamma-alumina --plate glass --out contactlaw.h
 *     nvcc -O3 event_driven.cu -o event_driven && ./event_driven
 */
#include "contactlaw.h"
#include <chrono>
#include <cstdio>
#include <vector>

static const int BEADS = 1000000, BOUNCES = 20;

/* Time from the release of bead n to the end of its last bounce [s]; each has its height and plate.
 * NaN: an impact outside the table. The same function runs on both sides. */
__host__ __device__ double bounce(int n)
{
    const double gravity = 9.81, radius = 0.9e-3, thickness = 0.5e-3 * (1 + n % 6);
    double speed = sqrt(2.0 * gravity * (0.1 + 0.9 * n / BEADS)), time = speed / gravity;
    for (int k = 0; k < BOUNCES; ++k) {
        speed *= contactlaw_restitution(speed, radius, thickness);
        time += 2.0 * speed / gravity;
    }
    return time;
}

__global__ void bounce_all(double *time)
{
    const int n = blockIdx.x * blockDim.x + threadIdx.x;
    if (n < BEADS)
        time[n] = bounce(n);
}

static double seconds() /* since the last call */
{
    static auto last = std::chrono::steady_clock::now();
    const auto before = last;
    last = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(last - before).count();
}

int main()
{
    const double impacts = double(BEADS) * BOUNCES;
    std::vector<double> host(BEADS), device(BEADS);
    double *time = nullptr, largest = 0.0;
    seconds();
    for (int n = 0; n < BEADS; ++n)
        host[n] = bounce(n);
    printf("one core: %.3g impacts/s, the first bead after %.9f s\n", impacts / seconds(), host[0]);
    cudaError_t error = cudaMalloc(&time, BEADS * sizeof(double));
    for (int run = 0; run < 2 && error == cudaSuccess; ++run) { /* the first one loads the code */
        seconds();
        bounce_all<<<(BEADS + 255) / 256, 256>>>(time);
        error = cudaDeviceSynchronize();
        if (run == 1 && error == cudaSuccess)
            printf("the GPU: %.3g impacts/s\n", impacts / seconds());
    }
    if (error == cudaSuccess)
        error = cudaMemcpy(device.data(), time, BEADS * sizeof(double), cudaMemcpyDeviceToHost);
    if (error != cudaSuccess) {
        fprintf(stderr, "no answer of a GPU: %s\n", cudaGetErrorString(error));
        return 1;
    }
    for (int n = 0; n < BEADS; ++n) /* written so that NaN counts, too */
        largest = fabs(device[n] - host[n]) <= largest ? largest : fabs(device[n] - host[n]);
    printf("largest difference of times: %.1e s\n", largest);
    return !(largest < 1e-9);
}
