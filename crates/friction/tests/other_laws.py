"""Reference trajectories of the elasto-plastic and the GMS law, from their published equations.

    python other_laws.py

Elasto-plastic: Dupont et al. 2002, doi 10.1109/TAC.2002.1000274, with z_ba a constant part of z_ss. GMS: Al-Bender et al.
2005, doi 10.1109/TAC.2005.858676. Both by scipy's solve_ivp (Radau, DOP853) at a relative tolerance of 1e-11, the GMS
elements with an event wherever one reaches its limit or the velocity goes through zero. The numbers printed are those in
`elasto_plastic.rs` and `gms.rs`.
"""

import numpy as np
from scipy.integrate import solve_ivp

FC, FS, VS = (20.0, 14.0), (31.0, 17.0), (5e-3, 2e-3)


def g(v):
    i = 0 if v >= 0 else 1
    return FC[i] + (FS[i] - FC[i]) * np.exp(-((v / VS[i]) ** 2))


def velocity(t):
    return 8e-3 * np.sin(2 * np.pi * 1.03 * t + 0.3) + 3e-3 * np.sin(2 * np.pi * 7.7 * t)


def elasto_plastic(s0, ratio, times):
    def rate(t, z):
        v = velocity(t)
        z, z_ss = z[0], g(v) / s0
        z_ba = ratio * z_ss
        if z * v <= 0 or abs(z) <= z_ba:
            alpha = 0.0
        elif abs(z) >= z_ss:
            alpha = 1.0
        else:
            alpha = 0.5 * np.sin(np.pi * (abs(z) - 0.5 * (z_ss + z_ba)) / (z_ss - z_ba)) + 0.5
        return [v * (1 - alpha * z / (np.sign(v) * z_ss if v else z_ss))]

    sol = solve_ivp(rate, (0, times[-1]), [0.0], "Radau", times, rtol=1e-11, atol=1e-17, max_step=2e-4)
    return sol.y[0]


def gms(k, nu, c, times):
    k, nu = np.array(k), np.array(nu)
    force, slips, t, out = np.zeros(len(k)), np.zeros(len(k), bool), 0.0, []
    pending = list(times)
    while pending:
        sign = np.sign(velocity(t + 1e-9))

        def rate(t, f):
            v = velocity(t)
            return np.where(slips, sign * c * (nu - sign * f / g(v)), k * v)

        # The velocity comes first: an event of it ends the stretch.
        events = [lambda t, f: velocity(t) if t > start + 1e-9 else sign]
        for i in range(len(k)):
            events.append(lambda t, f, i=i: -1.0 if slips[i] else sign * f[i] - nu[i] * g(velocity(t)))
        for e in events:
            e.terminal = True
        start = t
        sol = solve_ivp(rate, (t, pending[-1] + 1e-3), force, "DOP853", rtol=1e-11, atol=1e-13, events=events,
                        dense_output=True, max_step=1e-3)
        while pending and pending[0] <= sol.t[-1]:
            out.append(sol.sol(pending.pop(0)).sum())
        t, force = sol.t[-1], sol.y[:, -1]
        if len(sol.t_events[0]):
            slips = np.zeros(len(k), bool)
            t += 1e-12
        else:
            for i in range(len(k)):
                if len(sol.t_events[1 + i]):
                    slips = slips | (np.arange(len(k)) == i)
    return out


if __name__ == "__main__":
    times = 0.0973 * np.arange(1, 13)
    print("elasto-plastic z [um]", [float(f"{x * 1e6:.10g}") for x in elasto_plastic(1.2e5, 0.6, times)])
    print("GMS sum of forces [N]", [float(f"{x:.10g}") for x in gms([8e4, 3e4, 1e4], [0.5, 0.3, 0.2], 400.0, times)])
