//! Running a solver: for a budget, with a report after every step.

use super::schedule::Next;
use super::{Costs, Shooting};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// How far to go on; the settings' own stop holds beside it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Budget {
    /// At most so many more shots.
    pub shots: Option<u64>,
    /// At most so much more time of computing.
    pub time: Option<Duration>,
}

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// No more than the share of power asked for is unshot, and the log is drained.
    Converged,
    /// The bound on the error asked for is reached.
    Accurate,
    /// Shots or time are spent.
    Spent,
    /// The callback said so.
    Stopped,
}

/// What a step was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// A patch shot what it had unshot.
    Propagated {
        /// Patch.
        patch: usize,
    },
    /// A patch corrected what it had shot before an edit.
    Redistributed {
        /// Patch.
        patch: usize,
        /// State in which it had been shot.
        state: usize,
    },
    /// A patch shot towards an object that is being dragged.
    Previewed {
        /// Patch.
        patch: usize,
    },
}

/// What is told after every step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// The step.
    pub step: Step,
    /// Receivers it changed.
    pub receivers: usize,
    /// What has been spent since the solver was opened.
    pub costs: Costs,
}

impl Shooting {
    /// Shoots until the settings' stop is met, the budget is spent, or `after` breaks. `after` sees the solver after
    /// every step; its own time does not count.
    pub fn run(&mut self, budget: Budget, after: &mut dyn FnMut(&Self, &Event) -> ControlFlow<()>) -> End {
        let from = self.costs;
        let stop = self.params.stop;
        let spent = |limit: Option<u64>, shots: u64| limit.is_some_and(|n| shots >= n);
        let late = |limit: Option<f64>, seconds: f64| limit.is_some_and(|s| seconds >= s);
        loop {
            let (shots, seconds) = (self.costs.shots - from.shots, self.costs.seconds - from.seconds);
            if spent(stop.shots, shots) || spent(budget.shots, shots) {
                return End::Spent;
            }
            if late(stop.seconds, seconds) || late(budget.time.map(|t| t.as_secs_f64()), seconds) {
                return End::Spent;
            }
            let begin = Instant::now();
            if self.is_converged() {
                return End::Converged;
            }
            if stop.error.is_some_and(|e| self.error_bound().is_some_and(|bound| bound <= e)) {
                return End::Accurate;
            }
            let Some(next) = self.next() else { return End::Converged };
            let (step, receivers) = self.shoot(next);
            self.costs.seconds += begin.elapsed().as_secs_f64();
            let event = Event { step, receivers, costs: self.costs };
            if after(self, &event).is_break() {
                return End::Stopped;
            }
        }
    }

    /// Runs to the settings' stop.
    pub fn converge(&mut self) -> End {
        self.run(Budget::default(), &mut |_, _| ControlFlow::Continue(()))
    }

    fn is_converged(&self) -> bool {
        self.lamps.is_empty() && self.is_settled() && self.next_preview(true).is_none()
    }

    fn shoot(&mut self, next: Next) -> (Step, usize) {
        match next {
            Next::Propagate(patch) => (Step::Propagated { patch }, self.propagate(patch)),
            Next::Redistribute(v, patch) => {
                let state = self.versions[v].state;
                let receivers = self.redistribute(v, patch);
                // All that holds power is queued.
                if self.versions[v].queue.is_empty() {
                    self.versions.remove(v);
                }
                (Step::Redistributed { patch, state }, receivers)
            }
            Next::Preview(patch) => (Step::Previewed { patch }, self.shoot_preview(patch)),
        }
    }
}
