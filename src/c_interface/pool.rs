//! Threads that build and answer, shared by all who want the same number of them.

use super::refusal::Refusal;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::thread::JoinHandle;

/// More than any machine has processors for, and few enough to ask for in vain.
const MOST_THREADS: u32 = 1024;

/// Threads at work; they have ended when this is dropped.
pub struct Pool {
    threads: Option<rayon::ThreadPool>,
    handles: Arc<Mutex<Vec<JoinHandle<()>>>>,
}

/// All that somebody holds, by their number of threads.
static POOLS: Mutex<Vec<(u32, Weak<Pool>)>> = Mutex::new(Vec::new());

impl Pool {
    /// So many threads; 0 is one for each processor.
    ///
    /// # Errors
    /// If there are too many, or the system refuses them.
    pub fn of(threads: u32) -> Result<Arc<Pool>, Refusal> {
        if threads > MOST_THREADS {
            let why = format!("{threads} threads; expected 1 to {MOST_THREADS}, or LIGHTBUFFER_ALL_THREADS");
            return Err(Refusal::Argument(why));
        }
        let mut pools = locked(&POOLS);
        let found = pools.iter().find_map(|(number, pool)| pool.upgrade().filter(|_| *number == threads));
        if let Some(pool) = found {
            return Ok(pool);
        }
        let pool = Arc::new(Pool::start(threads)?);
        pools.retain(|(_, pool)| pool.strong_count() > 0);
        pools.push((threads, Arc::downgrade(&pool)));
        Ok(pool)
    }

    fn start(threads: u32) -> Result<Pool, Refusal> {
        let handles = Arc::new(Mutex::new(Vec::new()));
        let kept = Arc::clone(&handles);
        let start = move |thread: rayon::ThreadBuilder| {
            let name = format!("lightbuffer-{}", thread.index());
            let handle = std::thread::Builder::new().name(name).spawn(|| thread.run())?;
            locked(&kept).push(handle);
            Ok(())
        };
        let started =
            rayon::ThreadPoolBuilder::new().num_threads(threads as usize).spawn_handler(start).build();
        let threads = started.map_err(|e| Refusal::Refused(format!("threads cannot be started: {e}")))?;
        Ok(Pool { threads: Some(threads), handles })
    }

    /// Does something on these threads, and waits for it.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.threads.as_ref().expect("threads until it is dropped").install(work)
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        // Tells them to end; without waiting for it, they could outlive the program's memory, or the library.
        drop(self.threads.take());
        for thread in locked(&self.handles).drain(..) {
            // It has ended either way.
            let _ = thread.join();
        }
    }
}

/// Nothing is left half done under these locks.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_wants_as_many_threads_shares_them_while_somebody_holds_them() {
        let first = Pool::of(3).unwrap();
        assert!(Arc::ptr_eq(&first, &Pool::of(3).unwrap()));
        let other = Pool::of(2).unwrap();
        assert!(!Arc::ptr_eq(&first, &other));
        assert_eq!(
            (first.install(rayon::current_num_threads), other.install(rayon::current_num_threads)),
            (3, 2)
        );
        let gone = Arc::downgrade(&first);
        drop(first);
        assert_eq!(gone.strong_count(), 0);
        assert!(Pool::of(3).is_ok());
        assert!(matches!(Pool::of(1025), Err(Refusal::Argument(_))));
    }
}
