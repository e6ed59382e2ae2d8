"""Plan a drive through the shipped town: the optimal task plan, proved by clingo. No simulator runs."""

from tmpud import Problem

problem = Problem.of("millbrook", "park1e_0", "high4n")
report = problem.solve()

for step in report.plan:
    print(f"{step.action:<10}  {step.state.segment} -> {step.next_state.segment}")
print(f"{report.cost_m:.0f} m + {report.penalty_m:.0f} m safety penalty, optimal: {report.optimal}")

# What if the first merge were dangerous? Tell the planner, as the motion level does, and plan again.
problem.safe[report.plan[0]] = 0.0
again = problem.solve()
print(f"with Safe({report.plan[0].action}) = 0: {', '.join(step.action for step in again.plan)}")
print(f"{again.cost_m:.0f} m + {again.penalty_m:.0f} m safety penalty")
